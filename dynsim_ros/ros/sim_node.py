# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The node: ties a run to ROS time, topics, commands, parameters and services."""

import time

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node

from .clock import ClockPublisher
from .commands import Commands
from .context import one_line
from .diagnostics import Diagnostics
from .message_types import message_class
from .pacing import Pacer
from .parameters import Parameters, refused
from .qos import profile
from .run import Run
from .services import Services
from .topics import Topics
from ..messages.epoch import EPOCH
from ..messages.scene_channels import scene_channels
from ..scene import SceneError
from ..simulation import Simulator


class SimNode(Node):
    """
    Simulates a scene in real time.

    Raises SceneError if a parameter given at the start is wrong or a bag cannot be made. All
    callbacks run in one thread; they find the simulator at a tick boundary, and what they
    change holds from there on.
    """

    def __init__(self, name='dynsim'):
        try:
            super().__init__(name, automatically_declare_parameters_from_overrides=True)
        except ValueError as error:
            # rclpy does not name the parameter; what it cannot take is an empty list.
            raise SceneError('a parameter given at the start has no value, such as an empty '
                             f'list: {one_line(error)}') from None
        self.parameters = Parameters(self)
        simulator = Simulator(self.parameters.scene, self.parameters.settings)
        simulator.prepare()
        try:
            topics = Topics(self, scene_channels(simulator.scene, simulator.layout))
            self.run = Run(simulator, topics, ClockPublisher(self), self.parameters.own, self)
            self.commands = Commands(self, self.run)
        except (AssertionError, RuntimeError, TypeError) as error:
            # What rclpy raises for a quality of service that it was told by a parameter.
            raise SceneError(f'a qos_overrides parameter is wrong: '
                             f'{one_line(error) or "its type"}') from None
        self.parameters.check_qos_overrides()
        self._check_clock(self.get_parameter('use_sim_time').value,
                          self.parameters.own['publish_clock'])
        self.run_services = Services(self, self.run, self._resume, self._was_reset)
        self.pacer = Pacer(self.parameters.own['real_time_factor'])
        self.diagnostics = Diagnostics(self, self.run, self.pacer)
        self._epoch_publisher = self.create_publisher(
            message_class(EPOCH.type_name), f'~/{EPOCH.topic}', profile(EPOCH.qos))
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = None
        self._follows_clock = False
        self._clock_seen = 0
        self._restoring = False
        self.add_post_set_parameters_callback(self._parameters_were_set)
        self.run.waiting = self.get_parameter('use_sim_time').value
        if self.parameters.own['record.enable']:
            self.run.start_recording()

    def begin(self):
        """Publish the initial state and start the timers."""
        self._begin_epoch()
        self._schedule()
        self._diagnostics_timer = self.create_timer(1.0, self._publish_diagnostics,
                                                    clock=self._steady)

    def end(self):
        """Stop ticking and finish the bag."""
        if self._timer is not None:
            self._timer.cancel()
        self.run.stop_recording()

    def set_parameters_atomically(self, parameter_list):
        """Set a group of parameters, all of them or none, with our reasons where refused."""
        parameters = [self.parameters.converted(parameter) for parameter in parameter_list]
        values = {parameter.name: parameter.value for parameter in parameters}
        reason = self.parameters.refusal(parameters, self.run.simulator)
        if reason is None and not self._restoring:
            try:
                self._check_clock(
                    values.get('use_sim_time', self.get_parameter('use_sim_time').value),
                    values.get('publish_clock', self.parameters.own['publish_clock']))
            except SceneError as error:
                reason = str(error)
        if self._restoring:
            return super().set_parameters_atomically(parameters)
        if reason is not None:
            return refused(reason)
        return super().set_parameters_atomically(
            self.parameters.canonical(parameters, self.run.simulator))

    @staticmethod
    def _check_clock(follows, publishes):
        if follows and publishes:
            raise SceneError('publish_clock: the node cannot follow /clock (use_sim_time) and '
                             'publish it; set one of the two to false')

    def _parameters_were_set(self, parameters):
        if self._restoring:
            return
        self.parameters.accept(parameters)
        self.run.set_values(self.parameters.run_values(parameters))
        names = {parameter.name for parameter in parameters}
        if names & {'rate', 'real_time_factor', 'use_sim_time'}:
            self._schedule()

    def _schedule(self):
        """Set the timer to the rate, and let simulated time go on from now."""
        self.pacer.factor = self.parameters.own['real_time_factor']
        follows = self.get_parameter('use_sim_time').value
        if follows != self._follows_clock:
            self._follows_clock, self._clock_seen = follows, 0
        self.pacer.now = self._ros_now if self._follows_clock else time.monotonic_ns
        self.pacer.restart(self.run.simulator.time_ns)
        if self._timer is not None:
            self.destroy_timer(self._timer)
        period = self.pacer.period(self.run.simulator.settings.tick_ns) / 1e9
        self._timer = self.create_timer(period, self._advance, clock=self._steady)

    def _ros_now(self):
        return self.get_clock().now().nanoseconds

    def _advance(self):
        """Run the ticks that are due."""
        run = self.run
        if run.paused or run.finished or (self._follows_clock and not self._clock_is_good()):
            return
        simulator = run.simulator
        for _ in self.pacer.ticks_due(simulator.time_ns, simulator.settings.tick_ns):
            run.tick()
            if run.paused or run.finished:
                return

    def _clock_is_good(self):
        """Tell whether /clock has begun; if it was set back, begin a new epoch."""
        last, self._clock_seen = self._clock_seen, self._ros_now()
        if self._clock_seen == 0:
            return False
        if last == 0:
            self._follow()
        elif self._clock_seen < last:
            self.get_logger().warning('/clock was set back: reset')
            self.run.reset()
            self._was_reset()
        return True

    def _follow(self):
        """Go on with /clock from where it is now; a run that waited for it begins there."""
        time_ns = self.run.simulator.time_ns
        self.pacer.restart(time_ns)
        if self.run.waiting:
            self.run.waiting = False
            self.run.origin_ns = self._clock_seen - time_ns
            self.run.publish()

    def _resume(self):
        self.pacer.restart(self.run.simulator.time_ns)
        self.diagnostics.begin()

    def _was_reset(self):
        """Bring parameters and timer to the initial scene, and announce the epoch."""
        if self._follows_clock:
            self.run.origin_ns = self._clock_seen = self._ros_now()
            self.run.waiting = self.run.origin_ns == 0
        self._restoring = True
        try:
            for parameter in self.parameters.restore(self.run.simulator):
                self.set_parameters_atomically([parameter])
        finally:
            self._restoring = False
        self.diagnostics.begin()
        self._schedule()
        self._begin_epoch()

    def _begin_epoch(self):
        self._epoch_publisher.publish(EPOCH.encode(self.run.simulator.snapshot(), None))
        self.run.publish()

    def _publish_diagnostics(self):
        self.diagnostics.publish()
