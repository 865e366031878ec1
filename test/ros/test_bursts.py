# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Ticks that compiled code waits for and publishes are those that the interpreter makes."""

import threading

from bursting import Bursting
from dynsim_ros.cli.rerun import main as rerun
from dynsim_ros.messages.scene_channels import scene_channels
from dynsim_ros.messages.tick_rows import TickRows
from dynsim_ros.ros.bursts import prepare_bursts
from dynsim_ros.ros.sending import prepare_sending
from dynsim_ros.ros.ticker import Ticker
from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import MoveAnchor, Simulator
import pytest
from ros_client import Client, stamps

SCENE, RATE = load_scene('sphere_on_spring'), 1000.0
POSE, MARKERS = 'sphere/pose', 'markers'


class Bench(Bursting):
    """A run at the end of its first step, and what lets it burst; with_others: also markers."""

    def __init__(self, node, with_others=False):
        simulator = Simulator(SCENE, rate=RATE)
        simulator.prepare()
        prepare_sending()
        prepare_bursts()
        self.channels = [channel for channel in scene_channels(simulator.scene, simulator.layout)
                         if channel.row is not None or with_others and channel.topic == MARKERS]
        super().__init__(node, simulator, self.channels)
        while not simulator.known_ahead() > 10:
            simulator.advance_tick()

    def go_on(self):
        """Let it burst until a tick was run; return how many were: a busy machine may be late."""
        for _ in range(100):
            if ticks := self.go():
                return ticks
        raise AssertionError('no tick was run')


@pytest.fixture
def bench(node_here):
    return Bench(node_here)


def test_the_messages_are_those_of_single_ticks(bench):
    run, client = bench.run, Client()
    try:
        client.listen({channel.topic: channel.type_name for channel in bench.channels},
                      is_served=False)
        publishers = run.topics._publishers
        client.wait(lambda: all(publisher.get_subscription_count() for publisher in publishers))
        known, first = run.simulator.known_ahead(), run.simulator.tick
        ticks = bench.go_on()
        assert 0 < ticks <= known
        assert run.topics.built == ticks * len(bench.channels) and run.topics.skipped == 0
        client.wait(lambda: all(len(client.heard[channel.topic]) == ticks
                                for channel in bench.channels))
    finally:
        client.close()
    single = Simulator(SCENE, rate=RATE)
    single.advance_ticks(first)
    rows = TickRows(bench.channels, single.layout)
    for k in range(ticks):
        single.advance_tick()
        rows.fill(single.instant(), single.time_ns, rows.of())
        assert [client.heard[channel.topic][k] for channel in bench.channels] == [
            rows.message(i) for i in range(len(bench.channels))]
    assert run.simulator.memory()['state'] == single.memory()['state']


def test_what_comes_less_often_comes_with_the_last_tick(node_here):
    bench, client = Bench(node_here, with_others=True), Client()
    simulator, markers = bench.run.simulator, bench.channels[-1]
    assert markers.topic == MARKERS and markers.every(1_000_000) == 40
    try:
        client.listen({MARKERS: markers.type_name}, is_served=False)
        publisher = bench.run.topics._publishers[-1]
        client.wait(publisher.get_subscription_count)
        first, ends = simulator.tick, []
        while simulator.tick < first + 100:
            bench.go_on()
            ends.append(simulator.tick)
        due = range(first - first % 40 + 40, simulator.tick + 1, 40)
        client.wait(lambda: len(client.heard[MARKERS]) == len(due))
    finally:
        client.close()
    assert set(due) <= set(ends)
    rows, ticks = len(bench.channels) - 1, simulator.tick - first
    assert (bench.run.topics.built, bench.run.topics.skipped) == (rows * ticks + len(due), 0)
    for tick, message in zip(due, client.heard[MARKERS]):
        single = Simulator(SCENE, rate=RATE)
        single.advance_ticks(tick)
        assert message == markers.encode(single.snapshot(), single.time_ns)


def test_the_step_that_the_next_tick_needs_is_taken_before_that_is_due(bench):
    simulator = bench.run.simulator
    while known := simulator.known_ahead():
        simulator.take(known)
    assert bench.go_on() > 0
    single = Simulator(SCENE, rate=RATE)
    single.advance_ticks(simulator.tick)
    assert simulator.memory()['state'] == single.memory()['state']


def test_what_arrives_meanwhile_ends_it_before_the_next_tick(bench):
    done, build = [], bench.run.build_ahead

    def disturbed(*arguments):
        build(*arguments)
        bench.mailbox.tell(lambda: done.append(bench.run.simulator.tick))

    bench.mailbox.begin(threading.current_thread())
    bench.run.build_ahead = disturbed
    tick = bench.run.simulator.tick
    assert (bench.go(), done) == (0, [])
    bench.mailbox.hush()
    bench.mailbox.next_letter().carry_out()
    assert done == [tick]
    bench.run.build_ahead = build
    assert bench.go_on() > 0


@pytest.mark.parametrize('ticks_early', [0, 10_000])
def test_what_was_commanded_is_shown_at_once_but_no_more_than_a_tick_early(bench, ticks_early):
    run, pacer, tick_ns = bench.run, bench.pacer, round(1e9 / RATE)
    ticker = Ticker(run, pacer, lambda: True, run._options, None)
    tick, built = run.simulator.tick, run.topics.built
    pacer.restart(run.simulator.time_ns - ticks_early * tick_ns)
    # Before the next tick is due.
    ticker.mailbox.begin(threading.current_thread())
    ticker.mailbox.tell(lambda: run.carry_out(MoveAnchor('hand', (0.0, 0.0, 2.1))))
    now = pacer.now()
    pacer.now = lambda: now
    assert ticker._carry_out()
    ticker._show()
    shown = run.simulator.tick - tick
    assert shown == (0 if ticks_early else 1)
    assert run.topics.built - built == shown * len(bench.channels)


@pytest.mark.parametrize('prevent', [
    lambda bench: setattr(bench.run, 'paused', True),
    lambda bench: setattr(bench.run, 'waiting', True),
    lambda bench: setattr(bench.pacer, 'factor', 0.0),
    lambda bench: setattr(bench.pacer, 'factor', 0.1),
    lambda bench: setattr(bench.pacer, 'is_steady', False),
    lambda bench: setattr(bench.mailbox.alarm, 'functions', None),
    lambda bench: setattr(bench.run.topics._sending._rcl, 'publish', None),
    lambda bench: setattr(bench.run.topics._sending, '_is_laid_out', False),
    lambda bench: bench.mailbox.wake()],
    ids=['paused', 'waiting', 'as fast as possible', 'slow', 'another clock', 'another system',
         'another rcl', 'another layout', 'woken'])
def test_the_interpreter_does_it_where_it_has_to(bench, prevent):
    prevent(bench)
    bench.run.build_ahead = pytest.fail
    assert bench.go() == 0


def test_it_ends_where_the_run_does(bench):
    run = bench.run
    run._options['duration'] = run.simulator.time + 0.003
    assert 0 < bench.go_on() <= 3


def test_a_live_run_is_the_same_bits(start, connect):
    """Paused, at other speeds, commanded, listened to by more: no tick lacks, nor comes twice."""
    node = start('-p', f'rate:={RATE}', '-p', 'record.enable:=true')
    client, other = connect(node), connect(node)
    client.listen({POSE: 'geometry_msgs/msg/PoseStamped'})
    client.more(POSE, 200)
    for seconds in (1, 2):
        client.pause()
        client.pause(False)
        client.more(POSE, 50)
        client.configure({'real_time_factor': 0.5 * seconds})
        client.set_group({'spring.stiffness': 100.0 + seconds})
        other.listen({'sphere/twist': 'geometry_msgs/msg/TwistStamped'})
        client.more(POSE, 100)
    seen = stamps(client.messages(POSE))
    assert all(later - before == 1_000_000 for before, later in zip(seen, seen[1:]))
    node.stop()
    (bag,) = node.bags
    assert rerun([str(bag)]) == 0
