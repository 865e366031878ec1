# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A live run: the simulator, what it publishes and records, and what happens to it."""

import os
import time

import numpy as np

from ..bag.bag_files import Limits
from ..bag.bag_names import new_path
from ..bag.run_bag import RunBag
from ..messages.channel import Channel
from ..messages.qos import STATE
from ..scene import SceneError
from ..simulation import DivergenceError, SetValues, Simulator

# More ticks than any run has.
_FAR = 2 ** 62
DIAGNOSTICS = Channel('/diagnostics', 'diagnostic_msgs/msg/DiagnosticArray', None, STATE)


class Run:
    """
    What ticks, and what subscriptions and services act on; all in one thread, the Ticker's.

    simulator; topics: Topics; clock: ClockPublisher; options: dict of the node's own parameters,
    always up to date; node: the node, for its names and its log; origin_ns: added to simulated
    time in stamps; waiting: True until it is known, nothing is published before; is_over: to be
    set where the node is to end. work: how long the run's thread has been at steps, publishing
    and recording, by these names [ns]; lost: messages of bags that have ended which are not in
    them; history: [(paths of its files, simulated time at its beginning [ns])] of the bags that
    hold how the run came to where it is.
    """

    def __init__(self, simulator: Simulator, topics, clock, options, node):
        self.simulator = simulator
        self.topics = topics
        self.is_over = False
        self.bag = None
        self.origin_ns = 0
        self.waiting = False
        self.refused = 0
        self.work = {'step': 0, 'publish': 0, 'record': 0}
        self.lost = 0
        self.paused = False
        self._clock = clock
        self._options = options
        self._name = node.get_fully_qualified_name()
        self._resolve = topics.resolve
        self._log = node.get_logger()
        self._unrecorded = []
        self.history = []
        self._detached = []

    @property
    def stamp_ns(self):
        """Return the stamp of the present instant [ns]."""
        return self.origin_ns + self.simulator.time_ns

    @property
    def finished(self):
        """Tell whether the run is over, or has lasted as long as it was to last."""
        duration = self._options['duration']
        return self.is_over or duration > 0.0 and self.simulator.time_ns >= round(duration * 1e9)

    def ticks_to_wanted(self):
        """Return how many ticks it is to the next one that somebody waits for, 1 at least."""
        simulator, tick_ns = self.simulator, self.simulator.settings.tick_ns
        if self._options['publish_clock'] and self._clock.is_heard:
            return 1
        ticks = self.topics.schedule(tick_ns, self.bag is not None).ticks_to_wanted(simulator.tick)
        if ticks == 1:
            return 1
        return max(min(_FAR if ticks is None else ticks, self._ticks_to_end()), 1)

    def _ticks_to_end(self):
        """Return after how many ticks the run has lasted as long as it was to last."""
        duration, simulator = self._options['duration'], self.simulator
        if not duration:
            return _FAR
        return -((simulator.time_ns - round(duration * 1e9)) // simulator.settings.tick_ns)

    def advance(self, ticks, is_wanted):
        """
        Advance by some ticks; publish the last one if it is wanted.

        If the motion diverges, pause at the last state and say why.
        """
        simulator = self.simulator
        before, tick_ns = simulator.tick, simulator.settings.tick_ns
        begin = time.monotonic_ns()
        try:
            if ticks == 1:
                simulator.advance_tick()
            else:
                simulator.advance_ticks(ticks)
        except DivergenceError as error:
            self._pause_for(error)
            is_wanted = False
        self.work['step'] += time.monotonic_ns() - begin
        passed = simulator.tick - is_wanted
        if passed > before:
            self.topics.pass_over(before, passed, tick_ns)
        if is_wanted:
            self.publish()

    def _pause_for(self, error):
        """Pause at the last state, as the motion diverges."""
        self.paused = True
        self._log.error(f'paused: {error}; then call ~/reset')

    def now(self):
        """Return tick and time, as the services tell them."""
        return f'tick {self.simulator.tick}, {self.simulator.time:.9g} s'

    def epoch(self, problem):
        """Return epoch, tick and time; problem: why it is not recorded, in one line, or None."""
        text = f'epoch {self.simulator.epoch}, {self.now()}'
        return f'{text}; no longer recording: {problem}' if problem else text

    def publish(self):
        """Publish and record the present instant."""
        if self.waiting:
            return
        if self._options['publish_clock']:
            self._clock.publish(self.stamp_ns)
        begin = time.monotonic_ns()
        rows, messages = self.topics.publish(self.simulator, self.stamp_ns, self.bag is not None)
        built = time.monotonic_ns()
        self.record(messages, rows)
        self.work['publish'] += built - begin
        self.work['record'] += time.monotonic_ns() - built

    def stretch(self, most):
        """Return the Stretch of the next ticks, at most so many; None where there is none."""
        simulator = self.simulator
        if (self.paused or self.waiting or self.finished
                or (self._options['publish_clock'] and self._clock.is_heard)
                or (self.bag is not None and not self.bag.can_put_many)):
            return None
        schedule = self.topics.schedule(simulator.settings.tick_ns, self.bag is not None)
        return schedule.stretch(simulator.tick, min(self._ticks_to_end(), most))

    def known_of(self, stretch, most):
        """Return its first ticks, at most so many, whose states are known then, or None."""
        count = min(self.simulator.step_ahead(), most)
        return stretch.first(count) if count >= 1 else None

    def pass_by(self, stretch, count):
        """Run and record the first ticks of a Stretch that nobody hears; return how many were."""
        passed, simulator = 0, self.simulator
        while passed < count:
            before, begin = self.stamp_ns, time.monotonic_ns()
            try:
                instants = simulator.pass_ticks(count - passed)
            except DivergenceError as error:
                self._pause_for(error)
                break
            stepped = time.monotonic_ns()
            self.topics.rows.fill(instants, before + simulator.settings.tick_ns, stretch.due.rows)
            self.work['step'] += stepped - begin
            self.work['record'] += time.monotonic_ns() - stepped
            done = len(instants.states)
            self._take_note(stretch._replace(count=stretch.count - passed), done, before)
            passed += done
        if passed:
            self.bag.recorder.hurry()
        return passed

    def build_ahead(self, stretch):
        """Build the rows of a Stretch that known_of returned."""
        simulator = self.simulator
        self.topics.rows.fill(simulator.instants_ahead(stretch.count),
                              self.stamp_ns + simulator.settings.tick_ns, stretch.due.rows)

    def was_published(self, stretch, done):
        """Take note that its first so many were published; record them, and do what is left."""
        before = self.stamp_ns
        self.simulator.take(done)
        self._take_note(stretch, done, before)

    def _take_note(self, stretch, done, before):
        """Do that for ticks after a stamp [ns] that the simulator has passed."""
        simulator, begin = self.simulator, time.monotonic_ns()
        others = self.topics.were_published(stretch, done, simulator, self.stamp_ns)
        published = time.monotonic_ns()
        if self.bag is not None:
            tick_ns = simulator.settings.tick_ns
            self.bag.recorder.wait = self._may_wait()
            self.bag.put_many_rows(self.topics.rows,
                                   before + tick_ns * np.arange(1, done + 1), stretch.due.rows)
            self.record(others)
        self.work['publish'] += published - begin
        self.work['record'] += time.monotonic_ns() - published

    def _may_wait(self):
        """Tell whether the run may wait for the disk: one in steps, or to be faster than time."""
        factor = self._options['real_time_factor']
        return self.paused or factor == 0.0 or factor > 1.0

    def record(self, messages, rows=None):
        """Record {topic: CDR bytes}, and rows, at the present instant, if there is a bag."""
        if self.bag is not None and not self.waiting:
            self.bag.recorder.wait = self._may_wait()
            if rows is not None and rows.numbers:
                self.bag.put_rows(self.topics.rows, self.stamp_ns, rows)
            if messages:
                self.bag.put(self.stamp_ns, messages)
            self._tell_news(self.bag)

    def begin(self, origin_ns):
        """End the waiting: publish, and record what was commanded meanwhile."""
        self.waiting = False
        self.origin_ns = origin_ns
        # The first state is under these already.
        for command in self._unrecorded:
            self._record_command(command)
        self._unrecorded.clear()
        self.publish()

    def command(self, command):
        """Carry out a command and record it; raise SceneError if it is refused."""
        self._record_command(self.simulator.apply(command))

    def carry_out(self, command):
        """Do the same with what `checked` has returned."""
        self._record_command(self.simulator.carry_out(command))

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
        return self._begin_anew(self.simulator.reset)

    def go_on_as(self, simulator, parent=None, history=(), begins_bag=False):
        """
        Go on, in a new epoch, as a Simulator of the same kind of scene; else as reset.

        parent: {name: text} about where the state comes from, as RunBag takes it; history: of the
        bags that hold how it came about; begins_bag: whether one is begun even if there was none.
        """
        def take_over():
            simulator.follow(self.simulator)
            simulator.epoch += 1
            self.simulator = simulator

        return self._begin_anew(take_over, parent, history, begins_bag)

    def _begin_anew(self, change, parent=None, history=(), begins_bag=False):
        self._unrecorded.clear()
        begins_bag = self.detach_bag() or begins_bag
        change()
        self.history = list(history)
        if begins_bag:
            try:
                self.start_recording(parent)
            except SceneError as error:
                self._log.error(f'no longer recording: {error}')
                return str(error)
        return None

    def start_recording(self, parent=None):
        """Begin a bag and return its path; raise SceneError if it cannot be made."""
        if self.bag is not None:
            raise SceneError(f'recording already, to {self.bag.path}')
        directory = self._options['record.directory']
        try:
            self.bag = self._new_bag(directory, parent)
        except OSError as error:
            raise SceneError(f'record.directory: {directory} cannot be written to: '
                             f'{error.strerror or error}; choose another folder') from None
        # The checkpoint in it is under these.
        self._unrecorded.clear()
        self.history.append((self.bag.paths, self.simulator.time_ns))
        self._log.info(f'recording to {self.bag.path}')
        return self.bag.path

    def _new_bag(self, directory, parent):
        """Return a new RunBag; another node may choose the same name at the same moment."""
        options = self._options
        size, seconds = options['record.max_size'], options['record.max_duration']
        limits = Limits(size * 1e6 or None, round(seconds * 1e9) or None)
        while True:
            path = new_path(directory, self.simulator.scene.name, limits.are_set)
            try:
                return RunBag(
                    path, self.simulator, [*self.topics.channels, DIAGNOSTICS],
                    self.topics.rows, node=self._name, resolve=self._resolve,
                    compression=options['record.compression'], parameters=options,
                    limits=limits, sync_period=options['record.sync'], parent=parent)
            except FileExistsError:
                if not os.path.lexists(path):
                    raise

    def detach_bag(self):
        """End the recording, of which finish_bags does the rest; return whether there was one."""
        if self.bag is None:
            return False
        if not self.waiting:
            self.bag.put_last(self.stamp_ns, self.simulator)
        self._detached.append(self.bag)
        self.bag = None
        return True

    def finish_bags(self):
        """
        Finish the files of recordings that have ended, which takes its time; from any one thread.

        Logs what each holds, and returns it of the last one; None if there was none.
        """
        text = None
        while self._detached:
            bag = self._detached.pop(0)
            bag.close()
            self._tell_news(bag)
            recorder = bag.recorder
            self.lost += recorder.lost
            lost = f', {recorder.lost} lost: {recorder.error}' if recorder.lost else ''
            text = f'{bag.content}{lost}'
            self._log.info(f'recorded {text}')
        return text

    def _tell_news(self, bag):
        """Log what happened to a bag."""
        news = bag.recorder.news
        while news:
            is_error, line = news.popleft()
            if is_error:
                self._log.error(f'recorder: {line}; the run goes on')
            else:
                self._log.warning(f'recorder: {line}')
