# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Ticks recorded as rows: what others read is what was published, in the order of time."""

import gc
import tracemalloc

from dynsim_ros.bag.reader import open_bag
from dynsim_ros.bag.recorder import Recorder
from dynsim_ros.bag.run_bag import RunBag
from dynsim_ros.bag.writer import BagWriter
from dynsim_ros.messages.scene_channels import scene_channels
from dynsim_ros.messages.tick_rows import TickRows
from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import MoveAnchor, Simulator
from mcap.reader import make_reader
import numpy as np
import pytest
from rosbags.rosbag2.storage_mcap import McapReader

TICKS = 700


@pytest.fixture
def simulator():
    return Simulator(load_scene('sphere_on_spring'), rate=1000.0)


@pytest.fixture
def rows(simulator):
    return TickRows(scene_channels(simulator.scene, simulator.layout), simulator.layout)


def record_mixture(path, simulator, rows, compression):
    """Record ticks with rows that change, slow topics and a command; return what was put."""
    channels = scene_channels(simulator.scene, simulator.layout)
    markers = next(channel for channel in channels if channel.topic == 'markers')
    all_rows, poses = rows.of(), rows.of(rows.channels[:1] + rows.channels[-2:])
    bag = RunBag(path, simulator, channels, rows, compression=compression, wait=True)
    put = [('/dynsim/epoch', 0, None), ('/dynsim/state_hash', 0, None)]
    for tick in range(TICKS):
        stamp = simulator.time_ns
        wanted = all_rows if tick % 10 == 0 else poses
        rows.fill(simulator.instant(), stamp, wanted)
        bag.put_rows(rows, stamp, wanted)
        put += [(f'/dynsim/{rows.channels[i].topic}', stamp, rows.message(i))
                for i in wanted.numbers]
        if tick % 40 == 0:
            data = markers.encode(simulator.snapshot(), stamp)
            bag.put(stamp, {markers.topic: data})
            put.append((f'/dynsim/{markers.topic}', stamp, data + bytes(-len(data) % 4)))
        if tick == 300:
            bag.put_command(stamp, simulator.apply(MoveAnchor('hand', (0.1, 0.0, 2.0))))
            put.append(('/dynsim/hand/command', stamp, None))
        simulator.advance_tick()
    bag.close()
    assert (bag.recorder.lost, bag.recorder.error) == (0, None)
    assert bag.recorder.messages == len(put)
    return put


def same(found, put):
    assert len(found) == len(put)
    for (topic, stamp, data), other in zip(put, found):
        assert other[:2] == (topic, stamp)
        assert data is None or other[2] == data


@pytest.mark.parametrize('compression', ['zstd', 'lz4', 'none'])
def test_mcap_and_rosbags_read_what_was_published(tmp_path, simulator, rows, compression):
    path = tmp_path / 'run.mcap'
    put = record_mixture(path, simulator, rows, compression)
    with open(path, 'rb') as stream:
        reader = make_reader(stream, validate_crcs=True)
        summary = reader.get_summary()
        found = [(channel.topic, message.log_time, message.data)
                 for _, channel, message in reader.iter_messages()]
        only = [message.data for _, _, message in reader.iter_messages(
            topics=['/dynsim/energy'], start_time=100_000_000, end_time=200_000_000)]
    same(found, put)
    assert only == [data for topic, stamp, data in put
                    if topic == '/dynsim/energy' and 100_000_000 <= stamp < 200_000_000]
    assert summary.statistics.message_count == len(put)
    assert summary.statistics.chunk_count == len(summary.chunk_indexes) >= 1
    reader = McapReader(path)
    reader.open()
    try:
        same([(connection.topic, stamp, bytes(data)) for connection, stamp, data
              in reader.messages(reader.connections, 0, 2 ** 62)], put)
    finally:
        reader.close()
    with open_bag(path) as bag:
        same(list(bag.messages()), put)
        assert bag.complete


def test_many_ticks_at_once_are_the_same_file_content(tmp_path, simulator, rows):
    states = np.array([simulator.instant().states[0]] * 300)
    stamps = np.arange(300, dtype=np.int64) * 1_000_000
    found = []
    for at_once in (True, False):
        with Recorder(BagWriter(tmp_path / f'{at_once}.mcap')) as recorder:
            recorder.declare_rows(rows, [recorder.add_channel(f'/{channel.topic}',
                                                              channel.type_name)
                                         for channel in rows.channels])
            many = simulator.instant()._replace(states=states, period_ns=1_000_000)
            if at_once:
                rows.fill(many, 0, rows.of())
                recorder.put_many_rows(rows, stamps, rows.of())
            for stamp in () if at_once else stamps.tolist():
                rows.fill(simulator.instant()._replace(since_ns=stamp), stamp, rows.of())
                recorder.put_rows(rows, stamp, rows.of())
        assert recorder.lost == 0
        with open_bag(recorder.path) as bag:
            found.append(list(bag.messages()))
    assert found[0] == found[1] and len(found[0]) == 300 * len(rows.channels)


def test_recording_keeps_no_memory(tmp_path, simulator, rows):
    """Neither what was written nor what the summary will tell of it."""
    with Recorder(BagWriter(tmp_path / 'run.mcap', chunk_size=1000), capacity=1000,
                  wait=True) as recorder:
        recorder.declare_rows(rows, [recorder.add_channel(f'/{channel.topic}', channel.type_name)
                                     for channel in rows.channels])
        instant, wanted = simulator.instant(), rows.of()

        def put(ticks):
            for stamp in ticks:
                rows.fill(instant, stamp, wanted)
                recorder.put_rows(rows, stamp, wanted)
            while recorder.messages < (ticks[-1] + 1) * len(rows.channels):
                pass
            gc.collect()
            return tracemalloc.get_traced_memory()[0]

        tracemalloc.start()
        try:
            before = put(range(4000))
            after = put(range(4000, 12_000))
        finally:
            tracemalloc.stop()
        # Eight thousand chunks: the index of each takes 200 bytes.
        assert after - before < 400_000
    with open(recorder.path, 'rb') as stream:
        assert len(make_reader(stream).get_summary().chunk_indexes) >= 10_000


def test_ticks_that_find_no_room_are_counted(tmp_path, simulator, rows):
    recorder = Recorder(BagWriter(tmp_path / 'run.mcap'), capacity=50)
    recorder.declare_rows(rows, [recorder.add_channel(f'/{channel.topic}', channel.type_name)
                                 for channel in rows.channels])
    instant, wanted = simulator.instant(), rows.of()
    for stamp in range(3000):
        rows.fill(instant, stamp, wanted)
        recorder.put_rows(rows, stamp, wanted)
    recorder.close()
    assert recorder.lost > 0
    assert recorder.messages + recorder.lost == 3000 * len(rows.channels)
    with open_bag(recorder.path) as bag:
        assert bag.count == recorder.messages and bag.complete
