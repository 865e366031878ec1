# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The node: ties a run to ROS time, topics, commands, parameters and services."""

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node

from .clock import ClockPublisher
from .commands import Commands
from .compiling import Compiling
from .context import one_line
from .diagnostics import Diagnostics
from .message_types import message_class
from .pacing import LONGEST_STRIDE, Pacer
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

    is_ending: function that tells whether the program was asked to end. Raises SceneError if a
    parameter given at the start is wrong. All callbacks run in one thread; they find the simulator
    at a tick boundary, and what they change holds from there on.
    """

    def __init__(self, name='dynsim', is_ending=lambda: False):
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
        self._follows_clock = self.get_parameter('use_sim_time').value
        self._check_clock({})
        self.run_services = Services(self, self.run, self._resume, self._was_reset)
        self.pacer = Pacer(self.parameters.own['real_time_factor'])
        if self._follows_clock:
            self.pacer.now, self.pacer.longest_lag = self._ros_now, LONGEST_STRIDE
        self.compiling = Compiling(self.run, self.get_logger(),
                                   lambda: is_ending() or self.run.finished)
        self.diagnostics = Diagnostics(self, self.run, self.pacer)
        self._epoch_publisher = self.create_publisher(
            message_class(EPOCH.type_name), f'~/{EPOCH.topic}', profile(EPOCH.qos))
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = None
        self._clock_seen = 0
        self._restoring = False
        self.add_post_set_parameters_callback(self._parameters_were_set)
        self.run.waiting = self._follows_clock

    def begin(self):
        """
        Publish the initial state, start recording if wanted, and the timers.

        Raises SceneError if a bag cannot be made.
        """
        if self.parameters.own['record.enable']:
            self.run.start_recording()
        self._begin_epoch()
        self._schedule()
        self._diagnostics_timer = self.create_timer(1.0, self._publish_diagnostics,
                                                    clock=self._steady)

    def end(self):
        """Stop ticking and finish the bag; return whether all threads have ended."""
        self.run.stop_recording()
        if self._timer is not None:
            self._timer.cancel()
        return self.compiling.give_up()

    def set_parameters_atomically(self, parameter_list):
        """Set a group of parameters, all of them or none, with our reasons where refused."""
        if self._restoring:
            return super().set_parameters_atomically(parameter_list)
        parameters = [self.parameters.converted(parameter) for parameter in parameter_list]
        try:
            parameters = self.parameters.checked(parameters, self.run.simulator)
            self._check_clock({parameter.name: parameter.value for parameter in parameters})
            self.compiling.prepare(self.parameters.run_values(parameters), self._go_on)
        except SceneError as error:
            return refused(str(error))
        return super().set_parameters_atomically(parameters)

    def _check_clock(self, values):
        """Raise SceneError if new values of parameters do not go with the clock."""
        follows = values.get('use_sim_time', self._follows_clock)
        if follows != self._follows_clock:
            raise SceneError('use_sim_time: the clock of a run cannot be changed; give it at the '
                             'start')
        own = {**self.parameters.own, **values}
        if follows and own['publish_clock']:
            raise SceneError('publish_clock: the node cannot follow /clock (use_sim_time) and '
                             'publish it; set one of the two to false')
        if follows and own['real_time_factor'] == 0.0:
            raise SceneError('real_time_factor: 0 (as fast as possible) does not go with '
                             'following /clock (use_sim_time); set it above 0')

    def _parameters_were_set(self, parameters):
        if self._restoring:
            return
        self.parameters.accept(parameters)
        self.run.set_values(self.parameters.run_values(parameters))
        names = {parameter.name for parameter in parameters}
        self.run.record_settings({name: self.parameters.own[name]
                                  for name in names if name in self.parameters.own})
        if names & {'rate', 'real_time_factor'}:
            self._schedule()

    def _schedule(self):
        """Set the timer to the rate, and let simulated time go on from now."""
        self.pacer.factor = self.parameters.own['real_time_factor']
        self.pacer.restart(self.run.simulator.time_ns)
        before = self._timer
        period = self.pacer.period(self.run.simulator.settings.tick_ns) / 1e9
        self._timer = self.create_timer(period, self._advance, clock=self._steady)
        if before is not None:
            self.destroy_timer(before)

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

    def _go_on(self):
        """Run the ticks that are due; return how long there is nothing to do [s]."""
        run, tick_ns = self.run, self.run.simulator.settings.tick_ns
        self._advance()
        if run.paused or run.finished or run.waiting:
            return self.pacer.period(tick_ns) / 1e9
        return self.pacer.time_left(run.simulator.time_ns, tick_ns)

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
            self.run.begin(self._clock_seen - time_ns)

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
            self.set_parameters_atomically(self.parameters.restored(self.run.simulator))
        finally:
            self._restoring = False
        self.compiling.was_changed()
        self.diagnostics.begin()
        self._schedule()
        self._begin_epoch()

    def _begin_epoch(self):
        self._epoch_publisher.publish(EPOCH.encode(self.run.simulator.snapshot(), None))
        self.run.publish()

    def _publish_diagnostics(self):
        self.diagnostics.publish()
        self.compiling.prepare_ahead()
