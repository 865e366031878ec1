# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
How simulated time keeps up with real time.

The machine may be busy with other work: how fast simulated time goes at least is asked for with
much room, how fast at most is not.
"""

import time

import pytest
from ros_client import stamps
from scene_topics import DIAGNOSTICS, POSE

# How much simulated time may be caught up with at once, in real seconds, and some for delivery.
CATCHING_UP = 0.5


@pytest.fixture(scope='module')
def node(start):
    # a method that does not go over to another one, for which it would be compiled meanwhile
    return start('-p', 'integrator:=rk4')


@pytest.fixture(scope='module')
def client(node, connect):
    client = connect(node)
    client.listen({'sphere/pose': POSE, '/diagnostics': DIAGNOSTICS})
    client.more('sphere/pose')
    return client


def told(client):
    """Return {key: value} of the run in the next diagnostics."""
    (array, *_) = client.more('/diagnostics')
    return {item.key: item.value for item in array.status[0].values}


def measure(client, duration=1.0):
    """Return (simulated seconds per second, stamps [ns]) while some simulated time passes."""
    client.pause()
    client.clear()
    client.pause(False)
    begin = time.monotonic()
    client.wait(lambda: client.heard['sphere/pose'])
    first = stamps([client.last('sphere/pose')])[0]
    client.wait(lambda: stamps([client.last('sphere/pose')])[0] >= first + duration * 1e9)
    elapsed = time.monotonic() - begin
    client.pause()
    client.drain()
    times = stamps(client.messages('sphere/pose'))
    return (times[-1] - times[0]) * 1e-9 / elapsed, times


@pytest.mark.parametrize('rate', [100.0, 333.0, 1000.0])
def test_rate(client, rate):
    assert client.configure({'rate': rate, 'real_time_factor': 1.0})[0].successful
    factor, times = measure(client)
    tick = round(1e9 / rate)
    # not one tick is left out, however busy the machine is
    assert times == list(range(times[0], times[0] + len(times) * tick, tick))
    assert 0.4 < factor < 1.0 + CATCHING_UP


@pytest.mark.parametrize(('wanted', 'duration'), [(2.0, 2.0), (0.5, 0.5)])
def test_real_time_factor(client, wanted, duration):
    assert client.set_group({'rate': 100.0, 'real_time_factor': wanted}).successful
    factor, _ = measure(client, duration)
    assert 0.4 * wanted < factor < wanted * (1.0 + CATCHING_UP)


def test_as_fast_as_possible(client):
    assert client.set_group({'rate': 100.0, 'real_time_factor': 0.0}).successful
    client.pause(False)
    client.more('/diagnostics')
    # a machine that is busy holds it up
    client.wait(lambda: float(told(client)['real-time factor']) > 3.0)
    assert client.pause().success
    missed = told(client)['missed ticks']
    assert client.configure({'real_time_factor': 1.0})[0].successful
    # neither the fast time nor the pause is to be made up for
    factor, _ = measure(client, 0.5)
    assert factor < 1.0 + 2 * CATCHING_UP
    assert int(told(client)['missed ticks']) - int(missed) < 50


def test_more_than_the_machine_can_do(client):
    assert client.set_group({'rate': 10_000.0, 'real_time_factor': 1000.0}).successful
    client.pause(False)
    client.more('/diagnostics')
    assert int(told(client)['missed ticks']) > 1000
    begin = time.monotonic()
    assert client.pause().success
    assert time.monotonic() - begin < 10.0
    assert client.set_group({'rate': 100.0, 'real_time_factor': 1.0}).successful


def test_a_node_that_was_held_up_catches_up_a_little(node, client):
    client.pause()
    client.reset()
    before = told(client)
    client.clear()
    client.pause(False)
    client.more('sphere/pose', 20)
    node.suspend(0.7)
    client.more('sphere/pose', 40)
    client.pause()
    client.drain()
    after = told(client)
    missed, late = (int(after[key]) - int(before[key]) for key in ('missed ticks', 'late ticks'))
    # of the 70 ticks that were due at once at most 0.2 s are made up for
    assert missed >= 45
    assert late >= 10
    times = stamps(client.messages('sphere/pose'))
    assert times == list(range(times[0], times[0] + len(times) * 10 ** 7, 10 ** 7))


def test_a_long_pause_is_not_made_up_for(node, client):
    client.pause()
    before = told(client)
    client.more('/diagnostics')
    client.pause(False)
    client.more('sphere/pose', 3)
    client.pause()
    after = told(client)
    ticks = int(after['tick']) - int(before['tick'])
    missed = int(after['missed ticks']) - int(before['missed ticks'])
    assert ticks + missed < 60


def test_hardly_any_time_at_all(node, client):
    assert client.set_group({'rate': 100.0, 'real_time_factor': 1e-300}).successful
    client.pause(False)
    assert client.set_group({'real_time_factor': 1.0}).successful
    client.more('sphere/pose', 5)
