# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated time on /clock: published for others, or followed."""

from builtin_interfaces.msg import Time
from mcap.reader import make_reader
import pytest
from ros_client import nanoseconds, stamps
from rosgraph_msgs.msg import Clock
from scene_topics import DIAGNOSTICS, POSE

TICK = 10_000_000
SECOND = 1_000_000_000


@pytest.fixture(scope='module')
def follower(start):
    return start('-p', 'use_sim_time:=true', '-p', 'record.enable:=true', '-r', '__ns:=/follower',
                 name='/follower/dynsim')


class Time0:
    """Publishes /clock as a test tells it to."""

    def __init__(self, client):
        self._client = client
        self.now = 0

    def go_on(self, until):
        """Let the clock go to a time in steps of 20 ms, and the node with it."""
        while self.now < until:
            self.turn_to(self.now + 2 * TICK)

    def turn_to(self, now):
        """Set the clock [ns] and wait until the node has come to it, or begun anew there."""
        self.now = now
        message = Clock(clock=Time(sec=now // SECOND, nanosec=now % SECOND))
        self._client.publish('/clock', message)
        self._client.wait(lambda: self._at(now) or self._client.publish('/clock', message))

    def _at(self, now):
        heard = self._client.heard['sphere/pose']
        return heard and now - TICK < nanoseconds(
            self._client.last('sphere/pose').header.stamp) <= now


@pytest.fixture(scope='module')
def heard(follower, connect):
    """Give the stamps of poses in three spans of /clock, and the client."""
    client = connect(follower)
    client.listen({'sphere/pose': POSE, '/diagnostics': DIAGNOSTICS})
    (array, *_) = client.more('/diagnostics')
    waiting = array.status[0].message, len(client.heard['sphere/pose'])
    assert client.pause().success
    step = client.step()
    assert not step.success and step.message.startswith('waiting for /clock: ')
    assert client.pause(False).success
    # what is commanded before the clock begins is part of the run all the same
    assert client.configure({'gravity': 5.0})[0].successful
    clock = Time0(client)
    spans = []
    # it begins, is set back within what has passed, and to before it began
    for begin in (100 * SECOND, 100 * SECOND + 20 * TICK, 50 * SECOND):
        client.heard['sphere/pose'].clear()
        clock.turn_to(begin)
        clock.go_on(begin + 50 * TICK)
        spans.append(stamps(client.messages('sphere/pose')))
    return waiting, spans, client


def test_nothing_happens_before_the_clock_begins(heard):
    assert heard[0] == ('waiting for /clock', 0)


@pytest.mark.parametrize(('span', 'begin'), enumerate(
    (100 * SECOND, 100 * SECOND + 20 * TICK, 50 * SECOND)))
def test_stamps_are_the_time_of_the_clock(heard, span, begin):
    times = heard[1][span]
    assert times == list(range(begin, begin + 51 * TICK, TICK))


def test_a_clock_that_stands_still_stops_the_node(heard):
    client = heard[2]
    before = client.last('sphere/pose')
    client.more('/diagnostics')
    client.more('/diagnostics')
    assert client.last('sphere/pose') == before


def test_bags_begin_where_the_clock_does(heard, follower):
    heard[2].record(False)
    found = []
    for path in follower.bags:
        with open(path, 'rb') as stream:
            statistics = make_reader(stream).get_summary().statistics
        found.append((statistics.message_start_time, statistics.message_end_time))
    assert [begin for begin, _ in found] == [
        100 * SECOND, 100 * SECOND + 20 * TICK, 50 * SECOND]
    assert all(end - begin >= 50 * TICK for begin, end in found)
    with open(follower.bags[0], 'rb') as stream:
        ((_, _, change),) = make_reader(stream).iter_messages(
            topics=['/follower/dynsim/parameter_command'])
    assert change.log_time == 100 * SECOND and b'gravity' in change.data


def test_publishing_it_too_is_refused(heard):
    client = heard[2]
    (result,) = client.configure({'publish_clock': True})
    assert not result.successful and 'cannot follow /clock' in result.reason


@pytest.fixture(scope='module')
def leader(heard, follower, start, connect):
    follower.stop()
    client = connect(start('-p', 'publish_clock:=true'))
    client.listen({'/clock': 'rosgraph_msgs/msg/Clock', 'sphere/pose': POSE})
    client.more('/clock', 20)
    client.pause()
    client.drain()
    return client


def clocks(client):
    return [nanoseconds(message.clock) for message in client.messages('/clock')]


def test_published_every_tick(leader):
    times = clocks(leader)
    assert times == list(range(times[0], times[0] + len(times) * TICK, TICK))
    assert times[-1] == stamps([leader.last('sphere/pose')])[0]


def test_published_by_steps_and_resets(leader):
    leader.reset()
    leader.clear()
    leader.steps(3, '/clock')
    assert clocks(leader) == [TICK, 2 * TICK, 3 * TICK]
    leader.reset()
    leader.wait(lambda: clocks(leader)[-1] == 0)


def test_can_be_switched(leader):
    assert leader.configure({'publish_clock': False})[0].successful
    leader.clear()
    leader.steps(2, 'sphere/pose')
    assert not leader.heard['/clock']
    assert leader.configure({'publish_clock': True})[0].successful
    leader.steps(1, '/clock')


def test_following_it_too_is_refused(leader):
    (result,) = leader.configure({'use_sim_time': True})
    assert not result.successful and 'give it at the start' in result.reason
    assert leader.get('use_sim_time') == [False]
