# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The node: ties a run to ROS time, topics, commands, parameters and services."""

from contextlib import nullcontext

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node

from .audience import Audience
from .bursts import prepare_bursts
from .clock import ClockPublisher
from .commands import Commands
from .compiling import Compiling
from .context import one_line
from .diagnostics import Diagnostics
from .followed_clock import FollowedClock
from .handles import handles_for
from .log import Log
from .message_types import message_class
from .pacing import Pacer
from .parameters import Parameters, refused
from .qos import profile
from .recovering import Recovering
from .run import Run
from .sending import prepare_sending
from .services import Services
from .standard_services import offer_standard_services
from .states import States
from .stepping import Stepping
from .ticker import Ticker
from .topics import Topics
from ..bag.pack_rows import prepare_packing
from ..messages.epoch import EPOCH
from ..messages.scene_channels import scene_channels
from ..messages.tick_rows import TickRows
from ..scene import SceneError
from ..simulation import Simulator
from ..simulation.simulator import MOST_AHEAD

# How often to see who listens, where the middleware does not tell of changes [s].
_LOOK = 0.05


class SimNode(Node):
    """
    Simulates a scene in real time.

    is_ending: function that tells whether the program was asked to end; aside: as Log takes it.
    Raises SceneError if a parameter given at the start is wrong. The run ticks in the thread of a
    Ticker; callbacks are served by another thread, and what they want of the run goes through the
    ticker's mailbox: it is done at a tick boundary, and what it changes holds from there on.
    """

    def __init__(self, name='dynsim', is_ending=lambda: False, aside=nullcontext):
        self._aside = aside
        try:
            super().__init__(name, automatically_declare_parameters_from_overrides=True)
        except ValueError as error:
            # rclpy does not name the parameter; what it cannot take is an empty list.
            raise SceneError('a parameter given at the start has no value, such as an empty '
                             f'list: {one_line(error)}') from None
        self.parameters = Parameters(self)
        simulator = Simulator(self.parameters.scene, self.parameters.settings)
        simulator.prepare()
        # Who begins to listen, or to record, later on does not wait for it.
        prepare_sending()
        prepare_bursts()
        prepare_packing()
        self.audience = Audience(lambda: self.ticker.mailbox.wake())
        self._clock_publisher = ClockPublisher(self, self.audience)
        self.pacer = Pacer(self.parameters.own['real_time_factor'])
        try:
            self._tie(simulator)
        except (AssertionError, RuntimeError, TypeError) as error:
            # What rclpy raises for a quality of service that it was told by a parameter.
            raise SceneError(f'a qos_overrides parameter is wrong: '
                             f'{one_line(error) or "its type"}') from None
        self.parameters.check_qos_overrides()
        self._followed = None
        follows = self.get_parameter('use_sim_time').value
        self._check_clock({'use_sim_time': follows}, follows)
        if follows:
            self._followed = FollowedClock(self.get_clock(), self.run, self.pacer,
                                           self.ticker.mailbox.wake, self._was_set_back)
        self.compiling = Compiling(simulator, self.get_logger(),
                                   lambda: is_ending() or self.run.finished)
        self._offer_services(is_ending)
        self.diagnostics = Diagnostics(self, self.run, self.ticker, self.pacer, self.audience)
        self._epoch_publisher = self.create_publisher(
            message_class(EPOCH.type_name), f'~/{EPOCH.topic}', profile(EPOCH.qos))
        self._own_timers = []
        self._recovering = None
        self._restoring = False
        self.add_post_set_parameters_callback(self._parameters_were_set)

    def _tie(self, simulator):
        """Make what publishes the run, what it ticks in and what commands it."""
        channels = scene_channels(simulator.scene, simulator.layout,
                                  self.get_fully_qualified_name())
        rows = TickRows(channels, simulator.layout, reserve=MOST_AHEAD)
        topics = Topics(self, channels, rows, self.audience, self.parameters.own)
        self.run = Run(simulator, topics, self._clock_publisher, self.parameters.own, self)
        self.ticker = Ticker(self.run, self.pacer,
                             lambda: self._followed is None or self._followed.is_good(),
                             self.parameters.own, lambda line: self.get_logger().warning(line))
        self.commands = Commands(self, self.run, self.ticker.mailbox)
        self.handles = handles_for(self, simulator.scene, self._snapshot, self.commands.drag)

    def get_logger(self):
        """Return the logger of this node."""
        return Log(super().get_logger(), self._aside)

    def _offer_services(self, is_ending):
        run, ask, options = self.run, self._ask, self.parameters.own
        states = States(run, ask, options, prepare=self._prepare, resumed=self._resume,
                        goes_on=self._begin_anew, follow_up=self._follow_up)
        services = Services(self, run, ask, Stepping(run, is_ending), states, options,
                            resumed=self._resume, was_reset=self._was_reset,
                            follow_up=self._follow_up)
        offer_standard_services(self, run, ask, services, states, prepare=self._prepare,
                                follow_up=self._follow_up)

    def begin(self):
        """
        Publish the initial state, start recording if wanted, and let the run tick.

        Bags that were interrupted are recovered meanwhile. Raises SceneError if a bag cannot be
        made.
        """
        if self.parameters.own['publish_clock']:
            self._clock_publisher.begin()
        self._recovering = Recovering(self.parameters.own['record.directory'], self.get_logger())
        # Services are offered already: somebody may have been quicker.
        if self.parameters.own['record.enable'] and self.run.bag is None:
            self.run.start_recording()
        self._begin_epoch()
        self.diagnostics.begin()
        self.ticker.begin()
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._own_timers.append(self.create_timer(1.0, self._every_second, clock=steady))
        if not self.audience.is_told:
            self._own_timers.append(self.create_timer(_LOOK, self.audience.look, clock=steady))

    def end(self):
        """Stop ticking and finish the bag; return whether all threads have ended."""
        self.ticker.end()
        self.run.detach_bag()
        self.run.finish_bags()
        for timer in self._own_timers:
            timer.cancel()
        if self.handles is not None:
            self.handles.end()
        if self._recovering is not None:
            self._recovering.end()
        return self.compiling.give_up()

    def set_parameters_atomically(self, parameter_list):
        """Set a group of parameters, all of them or none, with our reasons where refused."""
        if self._restoring:
            return super().set_parameters_atomically(parameter_list)
        parameters = [self.parameters.converted(parameter) for parameter in parameter_list]
        try:
            parameters = self.parameters.checked(parameters, self.run.simulator)
            self._check_clock({parameter.name: parameter.value for parameter in parameters},
                              self._followed is not None)
            values = self.parameters.run_values(parameters)
            self.parameters.check_publish_rates(parameters, self.run.simulator.settings)
            if values:
                # Others are told who listens meanwhile: commands have to wait, subscribers not.
                self.compiling.prepare(self._copy(), values, self.audience.look)
        except SceneError as error:
            return refused(str(error))
        return super().set_parameters_atomically(parameters)

    def _prepare(self, simulator):
        """Return when all that a Simulator needs is compiled; SceneError if it cannot be."""
        self.compiling.prepare(simulator, {}, self.audience.look)

    def _copy(self):
        """Return a Simulator that stands where the one that runs does."""
        return self.ticker.mailbox.ask(self.run.simulator.copy)

    def _check_clock(self, values, follows):
        """Raise SceneError if new values of parameters do not go with the clock."""
        if values.get('use_sim_time', follows) != follows:
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
        if any(parameter.name == 'publish_clock' and parameter.value for parameter in parameters):
            self._clock_publisher.begin()
        self.ticker.mailbox.ask(lambda: self._change(parameters))

    def _change(self, parameters):
        """Let the run have new values of parameters, from the present instant on."""
        self.parameters.accept(parameters)
        self.run.topics.rates_changed()
        self.run.set_values(self.parameters.run_values(parameters))
        names = {parameter.name for parameter in parameters}
        self.run.record_settings({name: self.parameters.own[name]
                                  for name in names if name in self.parameters.own})
        if names & {'rate', 'real_time_factor'}:
            self._pace()

    def _pace(self):
        """Let simulated time go on from now, at the factor that is set."""
        self.pacer.factor = self.parameters.own['real_time_factor']
        self.pacer.restart(self.run.simulator.time_ns)

    def _resume(self):
        self.pacer.restart(self.run.simulator.time_ns)
        self.diagnostics.begin()

    def _was_set_back(self):
        self.get_logger().warning('/clock was set back: reset')
        self._was_reset()
        # In the thread that serves callbacks, as soon as it can.
        self.executor.create_task(self._follow_up)

    def _was_reset(self):
        """Begin a new epoch with what the start had, in the run's thread."""
        self.parameters.reset()
        self._begin_anew()

    def _ask(self, question):
        """Have question() answered by the run's thread; who listens by now hears what it does."""
        self.audience.look()
        return self.ticker.mailbox.ask(question)

    def _begin_anew(self):
        """Begin a new epoch, whose state is there, in the run's thread."""
        if self._followed is not None:
            self._followed.was_reset()
        self.run.topics.rates_changed()
        self.diagnostics.begin()
        self._pace()
        self._begin_epoch()

    def _follow_up(self):
        """Bring the parameters to the initial scene and finish the last epoch's bag."""
        self._restoring = True
        try:
            self.set_parameters_atomically(self.parameters.restored(self.run.simulator))
        finally:
            self._restoring = False
        self.compiling.was_changed()
        self.run.finish_bags()

    def _begin_epoch(self):
        self._epoch_publisher.publish(EPOCH.encode(self.run.simulator.snapshot(), None))
        self.run.publish()

    def _every_second(self):
        self.audience.look()
        self.ticker.mailbox.ask(self.diagnostics.publish)
        if self.handles is not None:
            self.handles.look()
        self.compiling.prepare_ahead(self._copy)

    def _snapshot(self):
        return self.ticker.mailbox.ask(self.run.simulator.snapshot)
