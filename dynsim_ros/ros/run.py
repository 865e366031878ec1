# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A live run: the simulator, what it publishes and records, and what happens to it."""

from ..bag.run_bag import new_path, RunBag
from ..messages.channel import Channel
from ..messages.qos import STATE
from ..scene import SceneError
from ..simulation import DivergenceError, SetValues, Simulator

DIAGNOSTICS = Channel('/diagnostics', 'diagnostic_msgs/msg/DiagnosticArray', None, STATE)


class Run:
    """
    What the node's timer, subscriptions and services act on; all of them in one thread.

    simulator; topics: Topics; clock: ClockPublisher; options: dict of the node's own parameters,
    always up to date; node: the node, for its names and its log; origin_ns: added to simulated
    time in stamps; waiting: True until it is known, nothing is published before.
    """

    def __init__(self, simulator: Simulator, topics, clock, options, node):
        self.simulator = simulator
        self.topics = topics
        self.bag = None
        self.origin_ns = 0
        self.waiting = False
        self.refused = 0
        self.paused = False
        self._clock = clock
        self._options = options
        self._name = node.get_fully_qualified_name()
        self._resolve = topics.resolve
        self._log = node.get_logger()
        self._bag_error = None
        self._unrecorded = []

    @property
    def stamp_ns(self):
        """Return the stamp of the present instant [ns]."""
        return self.origin_ns + self.simulator.time_ns

    @property
    def finished(self):
        """Tell whether the run has lasted as long as it was to last."""
        duration = self._options['duration']
        return duration > 0.0 and self.simulator.time_ns >= round(duration * 1e9)

    def tick(self):
        """Advance by one tick and publish; if the motion diverges, pause and say why."""
        try:
            self.simulator.advance_tick()
        except DivergenceError as error:
            self.paused = True
            self._log.error(f'paused: {error}; then call ~/reset')
            return
        self.publish()

    def publish(self):
        """Publish and record the present instant."""
        if self.waiting:
            return
        if self._options['publish_clock']:
            self._clock.publish(self.stamp_ns)
        tick_ns = self.simulator.settings.tick_ns
        messages = self.topics.publish(self.simulator.snapshot(), self.stamp_ns, tick_ns,
                                       self.bag is not None)
        self.record(messages)

    def record(self, messages):
        """Record {topic: CDR bytes} at the present instant, if there is a bag."""
        if self.bag is not None and messages and not self.waiting:
            # A run that is to be faster than time may wait for the disk, another one never.
            factor = self._options['real_time_factor']
            self.bag.recorder.wait = factor == 0.0 or factor > 1.0
            self.bag.put(self.stamp_ns, messages)
            self._report_bag_error()

    def begin(self, origin_ns):
        """End the waiting: publish, and record what was commanded meanwhile."""
        self.waiting = False
        self.origin_ns = origin_ns
        self.publish()
        for command in self._unrecorded:
            self._record_command(command)
        self._unrecorded.clear()

    def command(self, command):
        """Carry out a command and record it; raise SceneError if it is refused."""
        self._record_command(self.simulator.apply(command))

    def set_values(self, values):
        """Carry out a change of quantities or settings that was checked before."""
        if values:
            self.command(SetValues(values))

    def record_settings(self, values):
        """Record a change of the node's own parameters."""
        if values:
            self._record_command(SetValues(values))

    def _record_command(self, command):
        if self.waiting:
            # Its stamp is not known yet.
            self._unrecorded.append(command)
        elif self.bag is not None:
            self.bag.put_command(self.stamp_ns, command)

    def reset(self):
        """
        Begin a new epoch with the initial scene; a bag ends and a new one begins.

        Returns why the new one could not be made, in one line, or None.
        """
        was_recording = self.bag is not None
        self._unrecorded.clear()
        self.stop_recording()
        self.simulator.reset()
        if was_recording:
            try:
                self.start_recording()
            except SceneError as error:
                self._log.error(f'no longer recording: {error}')
                return str(error)
        return None

    def start_recording(self):
        """Begin a bag and return its path; raise SceneError if it cannot be made."""
        if self.bag is not None:
            raise SceneError(f'recording already, to {self.bag.path}')
        directory = self._options['record.directory']
        try:
            self.bag = self._new_bag(directory)
        except OSError as error:
            raise SceneError(f'record.directory: {directory} cannot be written to: '
                             f'{error.strerror or error}; choose another folder') from None
        self._bag_error = None
        self._log.info(f'recording to {self.bag.path}')
        return self.bag.path

    def _new_bag(self, directory):
        """Return a new RunBag; another node may choose the same name at the same moment."""
        while True:
            path = new_path(directory, self.simulator.scene.name)
            try:
                return RunBag(
                    path, self.simulator, [*self.topics.channels, DIAGNOSTICS], node=self._name,
                    resolve=self._resolve, compression=self._options['record.compression'],
                    parameters=self._options)
            except FileExistsError:
                if not path.exists():
                    raise

    def stop_recording(self):
        """End the bag; log and return what it holds, in words, None if there was none."""
        if self.bag is None:
            return None
        bag, self.bag = self.bag, None
        bag.close()
        recorder = bag.recorder
        lost = f', {recorder.lost} lost: {recorder.error or "the disk was too slow"}'
        text = f'{recorder.messages} messages in {bag.path}' + (lost if recorder.lost else '')
        self._log.info(f'recorded {text}')
        return text

    def _report_bag_error(self):
        error = self.bag.recorder.error
        if error is not None and error != self._bag_error:
            self._bag_error = error
            self._log.error(f'recorder: {error}; the run goes on')
