# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A bag in several files: each is a whole bag, tells how the run stood, and none lacks a tick."""

import json
import os
import time

from dynsim_ros.bag.bag_files import Limits
from dynsim_ros.bag.bag_names import new_path, next_part
from dynsim_ros.bag.run_bag import RunBag
from dynsim_ros.messages.scene_channels import scene_channels
from dynsim_ros.messages.tick_rows import TickRows
from dynsim_ros.scene import load_scene, scene_to_yaml
from dynsim_ros.simulation import SetValues, Simulator
from mcap.reader import make_reader

TICK = 10_000_000


def record(folder, limits, ticks, meanwhile=lambda tick: None):
    """Record a run in parts; return RunBag, simulator and {time: (poses of that tick)}."""
    simulator = Simulator(load_scene('sphere_on_spring'))
    channels = scene_channels(simulator.scene, simulator.layout)
    rows = TickRows(channels, simulator.layout)
    bag = RunBag(new_path(folder, 'scene', True), simulator, channels, rows, limits=limits,
                 parameters={'colour': 'red'}, wait=True)
    put = {}
    for tick in range(ticks):
        rows.fill(simulator.instant(), simulator.time_ns, rows.of())
        bag.put_rows(rows, simulator.time_ns, rows.of())
        put[simulator.time_ns] = rows.message(0)
        if tick == 120:
            bag.put_command(simulator.time_ns,
                            simulator.apply(SetValues({'spring.stiffness': 55.0})))
        meanwhile(bag)
        simulator.advance_tick()
    bag.close()
    bag.close()
    assert (bag.recorder.lost, bag.recorder.error) == (0, None)
    return bag, put


def read(path):
    """Return summary, metadata by name, scene and (topic, time, data) of a file, as mcap does."""
    with open(path, 'rb') as stream:
        reader = make_reader(stream, validate_crcs=True)
        return (reader.get_summary(),
                {item.name: item.metadata for item in reader.iter_metadata()},
                [item.data.decode() for item in reader.iter_attachments()
                 if item.name == 'scene.yaml'],
                [(channel.topic, message.log_time, message.data)
                 for _, channel, message in reader.iter_messages()])


def test_each_part_is_a_whole_bag_and_nothing_is_missing_between_them(tmp_path):
    bag, put = record(tmp_path, Limits(duration_ns=100 * TICK), 350)
    paths = bag.recorder.paths
    assert [path.name[-13:] for path in paths] == [f'part000{i}.mcap' for i in range(1, 5)]
    assert paths == sorted(tmp_path.iterdir())
    assert bag.content == f'{bag.recorder.messages} messages in {paths[0]} to {paths[3].name}'
    poses, total = {}, 0
    for number, path in enumerate(paths):
        summary, metadata, (scene,), messages = read(path)
        assert metadata['part'] == {'number': str(number + 1)}
        assert metadata['dynsim_ros']['start_tick'] == str(100 * number)
        assert summary.statistics.message_count == len(messages)
        assert len(summary.channels) == 17
        assert messages[0][:2] == ('/dynsim/epoch', 100 * number * TICK)
        times = [stamp for _, stamp, _ in messages]
        assert (times[0], times[-1]) == (100 * number * TICK,
                                         (min(100 * number + 99, 349)) * TICK)
        parameters = {name: json.loads(text) for name, text in metadata['parameters'].items()}
        assert parameters['colour'] == 'red'
        # changed at tick 120, in the second part
        assert parameters['spring.stiffness'] == (100.0 if number < 2 else 55.0)
        assert 'stiffness: 55' in scene if number > 1 else 'stiffness: 100' in scene
        poses.update({stamp: data for topic, stamp, data in messages
                      if topic == '/dynsim/sphere/pose'})
        total += len(messages)
    assert poses == put
    assert total == bag.recorder.messages


def test_a_part_ends_when_it_is_large_enough(tmp_path):
    def wait(bag):
        while bag.recorder.waiting > 100:
            time.sleep(0.001)

    bag, put = record(tmp_path, Limits(size=100_000), 400, wait)
    paths = bag.recorder.paths
    sizes = [path.stat().st_size for path in paths]
    assert len(paths) > 2 and all(90_000 <= size < 140_000 for size in sizes[:-1])
    times = [stamp for path in paths for topic, stamp, _ in read(path)[3]
             if topic == '/dynsim/sphere/pose']
    assert times == list(put)


def test_scene_is_what_it_is_then_not_at_the_start(tmp_path):
    bag, _ = record(tmp_path, Limits(duration_ns=130 * TICK), 131)
    scene = load_scene('sphere_on_spring')
    assert read(bag.recorder.paths[0])[2] == [scene_to_yaml(scene)]
    assert read(bag.recorder.paths[1])[2] != [scene_to_yaml(scene)]


def test_a_part_goes_to_the_folder_of_the_first_wherever_that_is_now(tmp_path):
    folder, elsewhere = tmp_path / 'runs', tmp_path / 'elsewhere'
    elsewhere.mkdir()

    def move(bag):
        if folder.exists() and not folder.is_symlink():
            folder.rename(tmp_path / 'moved')
            folder.symlink_to(elsewhere)

    bag, _ = record(folder, Limits(duration_ns=50 * TICK), 100, move)
    assert list(elsewhere.iterdir()) == []
    assert len(list((tmp_path / 'moved').iterdir())) == len(bag.recorder.paths) == 2


def test_names_stay_in_the_folder_and_in_order(tmp_path):
    for name in ('../../etc/passwd', '/etc/passwd', 'a/../b', '..', 'ü' * 300, 'x' * 300, '\n'):
        for in_parts in (False, True):
            path = new_path(tmp_path, name, in_parts)
            assert path.parent == tmp_path and len(os.fsencode(path.name)) < 255
            path.write_bytes(b'')
            assert path.resolve().parent == tmp_path
    first = new_path(tmp_path, 'scene', True)
    first.symlink_to(tmp_path / 'nowhere')
    assert new_path(tmp_path, 'scene', True) != first
    second = next_part(first)
    second.write_bytes(b'')
    assert next_part(first) == next_part(second) == first.with_name(
        first.name.replace('part0001', 'part0003'))
