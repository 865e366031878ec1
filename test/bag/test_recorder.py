# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
import os
import threading
import time

from bag_samples import sample_messages, TOPICS
from dynsim_ros.bag.reader import open_bag
from dynsim_ros.bag.recorder import Recorder
from dynsim_ros.bag.writer import BagWriter
import pytest

DATA = b'\0\1\0\0' + bytes(8)


@pytest.fixture
def writer(tmp_path):
    return BagWriter(tmp_path / 'run.mcap')


def test_everything_put_is_in_the_bag(writer):
    channels = {topic: writer.add_channel(topic, *what) for topic, what in TOPICS.items()}
    messages = sample_messages(2000)
    with Recorder(writer) as recorder:
        for topic, stamp, data in messages:
            recorder.put(stamp, [(channels[topic], data)])
        recorder.add_metadata('settings', {'a': 'b'})
        recorder.add_attachment('scene.yaml', b'x', 'application/yaml')
    recorder.close()
    assert (recorder.messages, recorder.lost, recorder.error) == (len(messages), 0, None)
    assert not [thread for thread in threading.enumerate() if thread.name == 'bag recorder']
    with open_bag(recorder.path) as bag:
        assert list(bag.messages()) == messages and bag.complete
        assert bag.metadata == {'settings': {'a': 'b'}}
        assert bag.attachments == {'scene.yaml': ('application/yaml', b'x')}


def test_messages_reach_the_file_while_recording(writer):
    with Recorder(writer) as recorder:
        channel = recorder.add_channel('/a', 'std_msgs/msg/UInt64')
        recorder.put(0, [(channel, DATA)])
        limit = time.monotonic() + 5
        count = 0
        while not count and time.monotonic() < limit:
            time.sleep(0.05)
            with open_bag(recorder.path) as bag:
                count = bag.count
        assert count == 1
    with open_bag(recorder.path) as bag:
        assert bag.complete and bag.count == 1


@pytest.mark.skipif(not hasattr(os, 'sched_setaffinity') or len(os.sched_getaffinity(0)) < 2,
                    reason='needs two processors, and a system that can choose')
def test_it_does_not_stay_where_it_was_begun(writer):
    """Begin to record in a thread that has to stay on one processor, as that of the ticks may."""
    recorders, usable = [], os.sched_getaffinity(0)

    def begin():
        os.sched_setaffinity(0, {min(usable)})
        recorders.append(Recorder(writer, sync_period=1.0))

    beginning = threading.Thread(target=begin)
    beginning.start()
    beginning.join()
    threads = [thread.native_id for thread in threading.enumerate()
               if thread.name in ('bag recorder', 'bag sync')]
    limit = time.monotonic() + 5
    while any(os.sched_getaffinity(thread) != usable for thread in threads):
        assert time.monotonic() < limit
        time.sleep(0.01)
    assert len(threads) == 2
    recorders[0].close()


def test_a_time_that_goes_back_is_kept_out(writer):
    with Recorder(writer) as recorder:
        channel = recorder.add_channel('/a', 'std_msgs/msg/UInt64')
        for stamp in (5, 3, 6):
            recorder.put(stamp, [(channel, DATA), (channel, DATA)])
    assert (recorder.messages, recorder.lost) == (4, 2)
    assert 'at 3 ns cannot follow one at 5 ns' in recorder.error
    with open_bag(recorder.path) as bag:
        assert [stamp for _, stamp, _ in bag.messages()] == [5, 5, 6, 6]


def test_what_is_no_message_is_an_error_not_the_end(writer):
    with Recorder(writer) as recorder:
        channel = recorder.add_channel('/a', 'std_msgs/msg/UInt64')
        recorder.put(0, [(channel, None)])
        recorder.put(1, [(channel, DATA)])
    assert recorder.lost == 1 and recorder.error


def test_overflow_is_lost_and_counted_or_waited_for(tmp_path):
    for wait in (False, True):
        recorder = Recorder(BagWriter(tmp_path / f'{wait}.mcap'), capacity=10, wait=wait)
        channel = recorder.add_channel('/a', 'std_msgs/msg/UInt64')
        for stamp in range(3000):
            recorder.put(stamp, [(channel, DATA)])
        recorder.close()
        assert recorder.messages + recorder.lost == 3000
        assert (recorder.lost == 0) == wait
        with open_bag(recorder.path) as bag:
            assert bag.count == recorder.messages and bag.complete


def test_put_after_close_is_lost(writer):
    recorder = Recorder(writer)
    recorder.close()
    recorder.put(0, [(1, DATA)])
    assert recorder.lost == 1


def test_put_is_cheap(writer):
    with Recorder(writer) as recorder:
        channel = recorder.add_channel('/a', 'std_msgs/msg/UInt64')
        batch = [(channel, DATA)] * 8
        times = []
        for stamp in range(2000):
            start = time.perf_counter()
            recorder.put(stamp, batch)
            times.append(time.perf_counter() - start)
            time.sleep(0.0001)
    # A loose bound: it would take the disk, or the writer's lock, to break it.
    assert sorted(times)[len(times) // 2] < 50e-6
    assert recorder.lost == 0
