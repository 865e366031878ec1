# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Exact steps of a paused node, as tests and learning need them: so many ticks and no more."""

import time

from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import MoveAnchor, Simulator
from geometry_msgs.msg import PointStamped, PoseStamped
import numpy as np
import pytest
from rclpy.serialization import deserialize_message
from ros_client import stamps
from ros_listener import Listener
from scene_topics import DIAGNOSTICS, POSE, positions
from std_srvs.srv import Trigger

TICK = 10_000_000


@pytest.fixture(scope='module')
def node(start):
    return start()


@pytest.fixture(scope='module')
def client(node, connect):
    client = connect(node)
    client.listen({'sphere/pose': POSE, '/diagnostics': DIAGNOSTICS})
    client.more('sphere/pose')
    return client


@pytest.fixture(autouse=True)
def at_the_beginning(client):
    client.pause()
    client.reset()
    client.configure({'step_count': 1.0})
    client.drain()
    client.clear()


def pose_of(heard):
    """Return the stamp [ns] of a pose as a Listener has heard it."""
    return stamps([deserialize_message(heard.data, PoseStamped)])[0]


def until(client, seconds):
    """Call ~/step_until; return the response."""
    assert client.configure({'step_until': seconds})[0].successful
    return client.call('step_until', Trigger)


def heard(client):
    """Return the stamps of all poses that have come, in ticks."""
    client.drain()
    return [stamp / TICK for stamp in stamps(client.messages('sphere/pose'))]


def test_so_many_ticks_and_no_more(client):
    for count, end in ((7, 7), (1, 8), (300, 308)):
        client.configure({'step_count': float(count)})
        response = client.step()
        assert (response.success, response.message) == (True, f'tick {end}, {end * 0.01:.9g} s')
    # it is over when it is answered: nothing comes later
    client.more('/diagnostics', 2)
    assert heard(client) == [*range(1, 309)]
    (array, *_) = client.more('/diagnostics')
    assert array.status[0].message == 'paused'


def test_who_is_away_for_a_while_misses_nothing(client):
    """Let a process that listens do nothing while more is published than finds room on its way."""
    listener = Listener(f'/dynsim/sphere/pose={POSE}')
    try:
        while not listener.heard:
            client.step()
            listener.wait(1, 0.1)
        first, count = pose_of(listener.heard[-1]), 900
        client.configure({'step_count': float(count)})
        listener.hold()
        client.step()
        listener.go_on()
        ticks = [pose_of(heard) for heard in listener.wait(count)]
        assert ticks[-count:] == [*range(first + TICK, first + (count + 1) * TICK, TICK)]
    finally:
        listener.close()


def test_until_an_instant(client):
    assert until(client, 0.5).message == 'tick 50, 0.5 s'
    # the first tick at or after it
    assert until(client, 0.501).message == 'tick 51, 0.51 s'
    refused = until(client, 0.51)
    assert (refused.success, refused.message) == (
        False, 'step_until: 0.51 s is not after the present, tick 51, 0.51 s')
    client.more('/diagnostics', 2)
    assert heard(client) == [*range(1, 52)]


def test_the_states_are_those_of_a_simulator(client):
    simulator = Simulator(load_scene('sphere_on_spring'))
    expected = []
    for x, count in ((0.1, 5), (0.2, 1), (-0.3, 12)):
        command = PointStamped()
        command.point.x, command.point.z = x, 2.0
        client.publish('hand/command', command)
        client.drain()
        client.configure({'step_count': float(count)})
        assert client.step().success
        simulator.apply(MoveAnchor('hand', (x, 0.0, 2.0)))
        for _ in range(count):
            simulator.advance_tick()
            expected.append(simulator.snapshot().position('sphere'))
    client.drain()
    np.testing.assert_array_equal(positions(client.messages('sphere/pose')), expected)


def test_refused_while_it_runs(client):
    client.pause(False)
    for response in (client.step(), until(client, 1e6)):
        assert (response.success, response.message) == (
            False, 'not paused: call ~/pause with data true first')


def test_a_count_has_to_be_a_whole_number(client):
    for value, reason in ((1.5, 'step_count: 1.5 is no whole number'),
                          (0.0, 'step_count: 0 is out of range: 1 to 1e+09')):
        (result,) = client.configure({'step_count': value})
        assert (result.successful, result.reason) == (False, reason)


def test_many_steps_do_not_keep_the_node_from_ending(node, client):
    client.configure({'step_count': 1e9})
    future = client.call_async('step', Trigger)
    client.more('sphere/pose', 50)
    begin = time.monotonic()
    node.stop()
    assert time.monotonic() - begin < 20.0
    assert not future.done() or not future.result().success
