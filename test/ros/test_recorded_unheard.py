# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A run that is recorded while nobody listens: many ticks at a time, all of them in the bag."""

from dynsim_ros.cli.rerun import main as rerun
from dynsim_ros.messages.scene_channels import scene_channels
from dynsim_ros.messages.tick_rows import TickRows
from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import Simulator
from other_readers import by_mcap

RATE, TICKS = 1000.0, 2000
SETTINGS = ('-p', f'rate:={RATE}', '-p', 'record.enable:=true')


def test_every_tick_is_in_the_bag_as_it_is_without_ros(start):
    node = start(*SETTINGS, '-p', f'duration:={TICKS / RATE}')
    node.wait()
    (bag,) = node.bags
    found, _ = by_mcap(bag)
    first = min(stamp for topic, stamp, _ in found if topic == '/dynsim/sphere/pose')
    simulator = Simulator(load_scene('sphere_on_spring'), rate=RATE)
    channels = scene_channels(simulator.scene, simulator.layout)
    rows = TickRows(channels, simulator.layout)
    topics, expected = [f'/dynsim/{channel.topic}' for channel in rows.channels], []
    for tick in range(TICKS + 1):
        stamp = first + simulator.time_ns
        rows.fill(simulator.instant(), stamp, rows.of())
        expected += [(topic, stamp, rows.message(i)) for i, topic in enumerate(topics)]
        if tick < TICKS:
            simulator.advance_tick()
    assert [message for message in found if message[0] in topics] == expected
    assert [stamp - first for topic, stamp, _ in found if topic == '/dynsim/markers'] == [
        40_000_000 * k for k in range(TICKS // 40 + 1)]
    assert rerun([str(bag)]) == 0


def test_a_motion_that_diverges_ends_at_its_last_tick(start, connect):
    node = start(*SETTINGS, '-p', 'integrator:=rk4', '-p', 'step:=0.001')
    client = connect(node)
    assert client.set_group({'spring.stiffness': 3e7, 'gravity': 1.62}).successful
    client.wait(lambda: 'is no longer finite' in node.output)
    assert node.output.count('then call ~/reset') == 1
    assert not client.step().success
    node.stop()
    (bag,) = node.bags
    times = [stamp for topic, stamp, _ in by_mcap(bag)[0] if topic == '/dynsim/sphere/pose']
    assert all(later - before == 1_000_000 for before, later in zip(times, times[1:]))
    assert rerun([str(bag)]) in (0, 1)
