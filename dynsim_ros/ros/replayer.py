# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Publishes what a bag holds, as it was and when it was."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
import time

from builtin_interfaces.msg import Time
from rclpy.duration import Duration
from rclpy.exceptions import InvalidTopicNameException
from rclpy.node import Node
from rclpy.qos import ReliabilityPolicy
from rclpy.validate_topic_name import validate_topic_name
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Trigger

from .playback import PlaybackTime
from .replay_topics import BURST, publishers_for, ReplayError
from ..bag.reader import Bag

# Longest wait at a stretch, and between two reports of progress, in s.
_PATIENCE = 0.05
_REPORT_PERIOD = 0.1

# How long to wait for further subscribers after one was found, in s.
_SETTLING = 1.0

# How long a burst pauses at half a queue so that what was lost on the way is sent again, in s.
_CATCHING_UP = 0.02

# How long the last messages may take after a stop was asked for, in s.
_PARTING = 0.2


@dataclass(frozen=True)
class ReplayOptions:
    """
    How to play a bag.

    rate: seconds of the bag per second, above 0. start_offset: what to leave out at the
    beginning, in s. duration: what to play behind that, in s, None for all. topics: names or
    patterns with * and ?, empty for all. remap: new names by recorded name. clock_hz: how often
    to publish /clock, 0 for never. wait: longest wait for subscribers before the first message,
    in s. wait_acked: longest wait at the end until they have confirmed the last ones, in s.
    """

    rate: float = 1.0
    loop: bool = False
    start_offset: float = 0.0
    duration: float | None = None
    topics: Sequence[str] = ()
    remap: Mapping[str, str] = field(default_factory=dict)
    clock_hz: float = 0.0
    start_paused: bool = False
    wait: float = 3.0
    wait_acked: float = 3.5


class Replayer:
    """
    Plays a bag from a node: topics, /clock and the services ~/pause and ~/resume.

    start_ns, end_ns: first and last time that is played; published: number of messages so far;
    warnings: one line for each thing that cannot be played. The node's services have to be
    served by another thread while `run` plays.
    """

    def __init__(self, node: Node, bag: Bag, options: ReplayOptions):
        """Create publishers and services; raises ReplayError where nothing can be played."""
        self._bag = bag
        self._options = options
        self.start_ns = bag.start_ns + round(options.start_offset * 1e9)
        self.end_ns = bag.end_ns
        if options.duration is not None:
            self.end_ns = min(self.end_ns, self.start_ns + round(options.duration * 1e9))
        self._check()
        self.published = 0
        self.warnings: list[str] = []
        self._publishers = publishers_for(
            node, [bag.channels[topic] for topic in self._selected()], options.remap,
            self.warnings)
        self._clock = node.create_publisher(Clock, '/clock', 1) if options.clock_hz else None
        self._next_clock = self._next_report = 0.0
        # Messages sent without a wait between them.
        self._in_a_row = 0
        self._report: Callable[[float], None] = lambda seconds: None
        self._time = PlaybackTime(options.rate, options.start_paused)
        self._time.restart(self.start_ns)
        node.create_service(Trigger, '~/pause', self._pause)
        node.create_service(Trigger, '~/resume', self._resume)

    @property
    def topics(self) -> list[str]:
        """Return the recorded names of the topics that are played."""
        return list(self._publishers)

    @property
    def paused(self) -> bool:
        """Tell whether playing is held."""
        return self._time.paused

    @property
    def duration(self) -> float:
        """Return how much of the bag is played, in s of its own time."""
        return (self.end_ns - self.start_ns) * 1e-9

    def run(self, stopped: Callable[[], bool], report: Callable[[float], None]) -> bool:
        """
        Play to the end, or until `stopped` says so; tell whether the end was reached.

        report: is given the seconds played, about ten times a second.
        """
        self._report = report
        if not self._options.start_paused:
            self._await_subscribers(stopped)
        finished = self._play(stopped)
        while finished and self._options.loop:
            finished = self._play(stopped)
        self._await_delivery(self._options.wait_acked if finished else _PARTING)
        return finished

    def _check(self):
        """Raise ReplayError where the options fit nothing in the bag."""
        bag, options = self._bag, self._options
        if not bag.count:
            raise ReplayError(f'{bag.path} holds no message that could be played')
        length = (bag.end_ns - bag.start_ns) * 1e-9
        if self.start_ns > bag.end_ns:
            raise ReplayError(f'start offset {options.start_offset:g} s lies behind the end of '
                              f'{bag.path}, which is {length:.3f} s long')
        if options.loop and self.end_ns == self.start_ns:
            raise ReplayError('a loop over 0 s would never rest: give a longer '
                              '--duration, or leave --loop out')
        for old, new in options.remap.items():
            if old not in bag.channels:
                raise ReplayError(f"no topic '{old}' to remap in {bag.path}: {self._known()}")
            try:
                validate_topic_name(new)
            except InvalidTopicNameException:
                raise ReplayError(f"cannot remap {old}: '{new}' is no topic name") from None

    def _selected(self) -> list[str]:
        """Return the recorded topics that are wanted."""
        wanted = self._bag.matching(self._options.topics)
        if self._options.clock_hz and self._options.remap.get('/clock', '/clock') == '/clock':
            # The clock of this replay replaces the recorded one.
            wanted = [topic for topic in wanted if topic != '/clock']
        return wanted

    def _known(self) -> str:
        """Return a clause that names the bag's topics."""
        return 'it has ' + ', '.join(sorted(self._bag.channels))

    def _await_subscribers(self, stopped: Callable[[], bool]):
        """
        Wait until every topic has a subscriber: what is sent before is lost to them.

        Others are found within 3 s as a rule. Where some topics have one, the rest gets another
        second.
        """
        publishers = [*self._publishers.values(), *([self._clock] if self._clock else [])]
        count, limit = 0, time.monotonic() + self._options.wait
        while time.monotonic() < limit and not stopped():
            found = sum(publisher.get_subscription_count() > 0 for publisher in publishers)
            if found == len(publishers):
                return
            if found > count:
                count, limit = found, min(limit, time.monotonic() + _SETTLING)
            time.sleep(0.01)

    def _play(self, stopped: Callable[[], bool]) -> bool:
        """Play once; tell whether the end was reached."""
        self._time.restart(self.start_ns)
        publishers = self._publishers
        for topic, log_ns, data in self._bag.messages(publishers, self.start_ns, self.end_ns):
            if not self._wait_for(log_ns, stopped):
                return False
            publishers[topic].publish(data)
            self.published += 1
            self._in_a_row += 1
            if self._in_a_row > BURST // 2:
                self._await_delivery(_CATCHING_UP)
        reached = self._wait_for(self.end_ns, stopped)
        self._publish_clock()
        self._report((min(self._time.now_ns(), self.end_ns) - self.start_ns) * 1e-9)
        return reached

    def _wait_for(self, bag_ns: int, stopped: Callable[[], bool]) -> bool:
        """Wait for a time in the bag; tell whether it came before a stop."""
        while not stopped():
            now = time.monotonic()
            if now >= self._next_report:
                self._next_report = now + _REPORT_PERIOD
                self._report((self._time.now_ns() - self.start_ns) * 1e-9)
            if self._clock and now >= self._next_clock:
                self._publish_clock()
                self._next_clock = max(self._next_clock + 1 / self._options.clock_hz, now)
            delay = self._time.seconds_to(bag_ns)
            if delay <= 0:
                return True
            if self._clock:
                delay = min(delay, self._next_clock - now)
            self._in_a_row = 0
            if self._time.changed.wait(min(delay, _PATIENCE)):
                self._time.changed.clear()
        return False

    def _publish_clock(self):
        """Publish the time of the bag, where a clock is wanted."""
        if self._clock:
            seconds, nanoseconds = divmod(min(self._time.now_ns(), self.end_ns), 10 ** 9)
            self._clock.publish(Clock(clock=Time(sec=seconds, nanosec=nanoseconds)))

    def _await_delivery(self, patience: float):
        """Wait until subscribers have what was sent: what no longer fits the queue is lost."""
        self._in_a_row = 0
        limit = time.monotonic() + patience
        for publisher in self._publishers.values():
            if publisher.qos_profile.reliability == ReliabilityPolicy.RELIABLE:
                publisher.wait_for_all_acked(
                    Duration(seconds=max(limit - time.monotonic(), 0.0)))

    def _pause(self, _, response):
        """Answer ~/pause."""
        return self._answer(response, 'paused', self._time.pause())

    def _resume(self, _, response):
        """Answer ~/resume."""
        return self._answer(response, 'playing', self._time.resume())

    def _answer(self, response, state: str, bag_ns: int):
        """Say what is so now, and since which time of the bag."""
        response.success = True
        response.message = f'{state} at {(bag_ns - self._bag.start_ns) * 1e-9:.3f} s'
        return response
