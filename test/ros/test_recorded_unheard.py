# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A run that is recorded while nobody listens: many ticks at a time, all of them in the bag."""

from pathlib import Path
import time

from dynsim_ros.cli.rerun import main as rerun
from dynsim_ros.messages.scene_channels import scene_channels
from dynsim_ros.messages.tick_rows import TickRows
from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import Simulator
from mcap.reader import make_reader

RATE, TICKS = 1000.0, 2000
SETTINGS = ('-p', f'rate:={RATE}', '-p', 'record.enable:=true')


def recorded(path):
    """Return {topic: [(log time [ns], bytes)]} of a bag."""
    found = {}
    with path.open('rb') as stream:
        for _, channel, message in make_reader(stream).iter_messages():
            found.setdefault(channel.topic, []).append((message.log_time, message.data))
    return found


def test_every_tick_is_in_the_bag_as_it_is_without_ros(start):
    node = start(*SETTINGS, '-p', f'duration:={TICKS / RATE}')
    node.wait()
    (bag,) = node.bags
    found = recorded(bag)
    first = found['/dynsim/sphere/pose'][0][0]
    simulator = Simulator(load_scene('sphere_on_spring'), rate=RATE)
    channels = scene_channels(simulator.scene, simulator.layout)
    rows = TickRows(channels, simulator.layout)
    expected = {f'/dynsim/{channel.topic}': [] for channel in rows.channels}
    for tick in range(TICKS + 1):
        stamp = first + simulator.time_ns
        rows.fill(simulator.instant(), stamp, rows.of())
        for i, topic in enumerate(expected):
            expected[topic].append((stamp, rows.message(i)))
        if tick < TICKS:
            simulator.advance_tick()
    assert {topic: found[topic] for topic in expected} == expected
    assert [stamp - first for stamp, _ in found['/dynsim/markers']] == [
        40_000_000 * k for k in range(TICKS // 40 + 1)]
    assert rerun([str(bag)]) == 0


def test_it_wakes_up_where_markers_are_due_and_no_more_often(start, connect):
    node = start(*SETTINGS)
    client = connect(node)
    client.listen({'/diagnostics': 'diagnostic_msgs/msg/DiagnosticArray'})
    client.more('/diagnostics', 2)
    tasks = [*Path(f'/proc/{node.process.pid}/task').iterdir()]

    def awake():
        return {task: int(line.split()[1]) for task in tasks if task.exists()
                for line in (task / 'status').read_text().splitlines()
                if line.startswith('voluntary_ctxt')}

    before, begin = awake(), time.monotonic()
    time.sleep(2.0)
    seconds, after = time.monotonic() - begin, awake()
    # 25 times a second each are the thread that ticks and the one that writes.
    assert max(after[task] - before[task] for task in before) < 100 * seconds
    node.stop()


def test_a_motion_that_diverges_ends_at_its_last_tick(start, connect):
    node = start(*SETTINGS, '-p', 'integrator:=rk4', '-p', 'step:=0.001')
    client = connect(node)
    assert client.set_group({'spring.stiffness': 3e7, 'gravity': 1.62}).successful
    client.wait(lambda: 'is no longer finite' in node.output)
    assert node.output.count('then call ~/reset') == 1
    assert not client.step().success
    node.stop()
    (bag,) = node.bags
    times = [stamp for stamp, _ in recorded(bag)['/dynsim/sphere/pose']]
    assert all(later - before == 1_000_000 for before, later in zip(times, times[1:]))
    assert rerun([str(bag)]) in (0, 1)
