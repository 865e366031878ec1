# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A run that nobody looks at sleeps, and comes to the same states all the same."""

from collections import Counter
from pathlib import Path
import time

from dynsim_ros.cli.rerun import main as rerun
from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import MoveAnchor, Simulator
from geometry_msgs.msg import PointStamped
from mcap.reader import make_reader
import pytest
from ros_client import stamps
from scene_topics import DIAGNOSTICS, POSE, positions

TICK = 1_000_000


@pytest.fixture(scope='module')
def node(start):
    # a method that does not go over to another one, for which it would be compiled meanwhile
    return start('-p', 'rate:=1000.0', '-p', 'integrator:=rk4', '-p', 'publish_clock:=true')


@pytest.fixture(scope='module')
def client(node, connect):
    client = connect(node)
    client.listen({'/diagnostics': DIAGNOSTICS})
    client.more('/diagnostics')
    return client


def told(client):
    """Return {key: value} of the run in the next diagnostics."""
    (array, *_) = client.more('/diagnostics')
    return {item.key: item.value for item in array.status[0].values}


def times_awake(node):
    """Return Counter {thread: how often it has gone to sleep so far} of the node's process."""
    return Counter({path: int(line.split()[1])
                    for path in Path(f'/proc/{node.process.pid}/task').glob('*/status')
                    for line in path.read_text().splitlines()
                    if line.startswith('voluntary_ctxt')})


def test_it_sleeps_and_time_goes_on(client, node):
    before, awake = told(client), times_awake(node)
    client.more('/diagnostics', 2)
    after, awake = told(client), times_awake(node) - awake
    first, last = int(before['tick']), int(after['tick'])
    key, ticks = 'messages not built (nobody listened)', last - first
    assert ticks > 1500 and after['missed ticks'] == before['missed ticks']
    # far less often than it ticks, all that the middleware does included
    assert awake.total() < ticks / 3
    # nine topics every tick, frames and markers every 40th, the hash every 1000th
    assert int(after[key]) - int(before[key]) == (
        9 * ticks + 2 * (last // 40 - first // 40) + last // 1000 - first // 1000)


def test_who_joins_sees_the_next_tick(client):
    client.listen({'sphere/pose': POSE})
    begin = time.monotonic()
    client.more('sphere/pose')
    # each finds the other within milliseconds; otherwise it would sleep for up to a second
    assert time.monotonic() - begin < 0.5
    client.more('sphere/pose', 200)
    client.pause()
    client.drain()
    messages = client.messages('sphere/pose')
    times = stamps(messages)
    assert times == list(range(times[0], times[0] + len(times) * TICK, TICK))
    simulator = Simulator(load_scene('sphere_on_spring'), rate=1000.0, integrator='rk4')
    simulator.advance(times[0])
    for time_ns, position in zip(times, positions(messages).tolist()):
        simulator.advance(time_ns - simulator.time_ns)
        assert simulator.snapshot().position('sphere').tolist() == position


def test_a_command_that_nobody_sees(start, connect):
    """Command a node that sleeps; what is recorded of it is when it took effect."""
    node = start('-p', 'rate:=1000.0', '-p', 'integrator:=rk4', '-r', '__ns:=/unseen',
                 name='/unseen/dynsim')
    client = connect(node)
    command = PointStamped()
    command.point.x = 0.5
    client.publish('hand/command', command)
    time.sleep(0.3)
    tick = int(client.pause().message.split()[3].rstrip(','))
    client.listen({'sphere/pose': POSE})
    # on a busy machine the command may come after the pause: what it changes is published again
    *_, message = client.steps(1, 'sphere/pose')
    found = positions([message]).tolist()[0]
    # it took effect at one of the ticks between, and at none else
    assert found in [after_command(at, tick + 1) for at in range(max(tick - 1500, 0), tick + 2)]


def test_what_is_only_recorded(start, connect):
    """Every tick is in the bag, also those around commands, but none wakes the node on its own."""
    # a method whose steps go past many ticks
    node = start('-p', 'rate:=1000.0', '-p', 'integrator:=extrapolation', '-p',
                 'record.enable:=true', '-r', '__ns:=/recorded', name='/recorded/dynsim')
    client = connect(node)
    client.wait(lambda: node.bags)
    begin, awake = time.monotonic(), times_awake(node)
    # no event would do: whatever asks the node wakes it
    time.sleep(1.5)
    awake, seconds = times_awake(node) - awake, time.monotonic() - begin
    command = PointStamped()
    for i in range(20):
        command.point.x, command.point.z = 0.01 * i, 2.0
        client.publish('hand/command', command)
        # between ticks that have passed, not all at one
        time.sleep(0.01)
    tick = int(client.pause().message.split()[3].rstrip(','))
    node.stop()
    (bag,) = node.bags
    with bag.open('rb') as stream:
        times = [message.log_time for *_, message in make_reader(stream).iter_messages(
            ['/recorded/dynsim/sphere/pose'])]
    assert times == list(range(0, (tick + 1) * TICK, TICK))
    assert rerun([str(bag)]) == 0
    # all that is written and all that the middleware does included
    assert awake.total() < 1000 * seconds / 2
    # 25 times a second each the thread that ticks and the one that writes
    assert max(awake.values()) < 100 * seconds


def after_command(at, ticks):
    """Return where the sphere is after so many ticks, with a command after some of them."""
    simulator = Simulator(load_scene('sphere_on_spring'), rate=1000.0, integrator='rk4')
    simulator.advance_ticks(at)
    simulator.apply(MoveAnchor('hand', (0.5, 0.0, 0.0)))
    simulator.advance_ticks(ticks - at)
    return simulator.snapshot().position('sphere').tolist()
