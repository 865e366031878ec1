# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A disk that is full, or slow: what the bag lacks is counted, told at once, and in the bag."""

import subprocess
import sys
import threading
import time

from bag_samples import sample_messages
from dynsim_ros.bag import output
from dynsim_ros.bag.reader import open_bag
from dynsim_ros.bag.recorder import Recorder
from dynsim_ros.bag.writer import BagWriter
from mcap.reader import make_reader
import pytest

DATA = b'\0\1\0\0' + bytes(8)

FULL = """
import resource, sys, time
from bag_samples import sample_messages, TOPICS
from dynsim_ros.bag.recorder import Recorder
from dynsim_ros.bag.writer import BagWriter
limit = lambda size: resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY))

def until(condition):
    end = time.monotonic() + 30.0
    while not condition() and time.monotonic() < end:
        time.sleep(0.001)

limit(50_000)
writer = BagWriter(sys.argv[1], compression='none', chunk_size=6000)
channels = {topic: writer.add_channel(topic, *what) for topic, what in TOPICS.items()}
recorder = Recorder(writer, capacity=100)
is_full = True  # only then may those that wait become too many
for number, (topic, stamp, data) in enumerate(sample_messages(1000)):
    recorder.put(stamp, [(channels[topic], data)], keep=number == 1000)
    if number % 50 == 0:
        until(lambda: recorder.waiting < 50 or is_full and recorder.is_failing)
    if number == 1000 and sys.argv[2] == 'room':
        limit(10 ** 9)
        is_full = False
        until(lambda: not recorder.waiting)
recorder.close()
recorder.close()
print(recorder.messages, recorder.lost, recorder.error)
for _, line in recorder.news:
    print(line)
"""


def run_full(path, room):
    """Record where the disk gets full; return messages, lost, error and the news."""
    process = subprocess.run(
        [sys.executable, '-c', f'import sys\nsys.path[:0] = {sys.path!r}\n{FULL}', path, room],
        capture_output=True, text=True, timeout=60)
    assert (process.returncode, process.stderr) == (0, '')
    first, *news = process.stdout.splitlines()
    messages, lost, error = first.split(maxsplit=2)
    return int(messages), int(lost), error, news


def gaps(bag):
    """Return what a bag tells of what it lacks."""
    return [values for name, values in bag.metadata.items() if name.startswith('missing_')]


def test_a_full_disk_stops_the_bag_not_the_run(tmp_path):
    path = tmp_path / 'run.mcap'
    messages, lost, error, news = run_full(path, '')
    assert messages + lost == 2001 and messages > 100
    assert error == f'{path} cannot be written: File too large'
    assert news[0] == error
    assert news[1].startswith('messages are lost from ') and news[1].endswith(f': {error}')
    assert news[-1] == (f'{path} is not finished: File too large; recover it when there is room')
    with open_bag(path) as bag:
        assert list(bag.messages()) == sample_messages(1000)[:messages]


def test_it_goes_on_when_there_is_room_and_the_bag_tells_what_is_missing(tmp_path):
    path = tmp_path / 'run.mcap'
    messages, lost, error, news = run_full(path, 'room')
    assert messages + lost == 2001 and lost > 0
    assert f'{path} is written again' in news
    with open(path, 'rb') as stream:
        assert make_reader(stream, validate_crcs=True).get_summary(
            ).statistics.message_count == messages
    put = sample_messages(1000)
    kept = put.pop(1000)
    with open_bag(path) as bag:
        found = list(bag.messages())
        (gap,) = gaps(bag)
        assert bag.complete
    # what was to be kept is there, in its place, though all around it is missing
    assert found.count(kept) == 1 and found == sorted(found, key=lambda message: message[1])
    missing = [message for message in put if message not in found]
    assert (int(gap['messages']), gap['reason']) == (lost, error)
    assert (int(gap['first_ns']), int(gap['last_ns'])) == (missing[0][1], missing[-1][1])
    assert len(missing) == lost
    line = next(line for line in news if 'are missing' in line)
    assert f'{lost} messages from {missing[0][1] * 1e-9:.3f} s' in line


@pytest.fixture
def slow_disk(monkeypatch):
    """Give an event: as long as it is not set, nothing gets to the disk."""
    event, write = threading.Event(), output.Output.write

    def wait_and_write(self, data):
        event.wait()
        return write(self, data)

    event.set()
    monkeypatch.setattr(output.Output, 'write', wait_and_write)
    yield event
    event.set()


def until(condition):
    end = time.monotonic() + 30.0
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.001)


def test_a_slow_disk_costs_what_finds_no_room_and_no_more(tmp_path, slow_disk):
    recorder = Recorder(BagWriter(tmp_path / 'run.mcap'), capacity=100)
    channel = recorder.add_channel('/a', 'std_msgs/msg/UInt64')
    slow_disk.clear()
    recorder.put(0, [(channel, DATA)])
    # the thread has taken this one, and is at the disk with it
    until(lambda: recorder.waiting == 0)
    for stamp in range(1, 151):
        recorder.put(stamp, [(channel, DATA)])
        assert recorder.waiting <= 100
    assert (recorder.waiting, recorder.lost, recorder.is_failing) == (100, 50, True)
    assert recorder.news[0] == (True, 'messages are lost from 0.000 s on, until half of the 100 '
                                'that wait are written: the disk is too slow')
    recorder.put(151, [(channel, DATA)] * 3, keep=True)
    assert (recorder.waiting, recorder.lost) == (103, 50)
    slow_disk.set()
    until(lambda: recorder.waiting == 0)
    recorder.put(152, [(channel, DATA)])
    recorder.close()
    assert (recorder.messages, recorder.lost, recorder.is_failing) == (105, 50, False)
    with open_bag(recorder.path) as bag:
        assert [stamp for _, stamp, _ in bag.messages()] == [*range(101), 151, 151, 151, 152]
        assert gaps(bag) == [{'messages': '50', 'first_ns': '101', 'last_ns': '150',
                              'reason': 'the disk is too slow'}]


def test_gaps_are_few_however_long_it_is_slow(tmp_path, slow_disk):
    recorder = Recorder(BagWriter(tmp_path / 'run.mcap', chunk_size=100), capacity=100)
    channel = recorder.add_channel('/a', 'std_msgs/msg/UInt64')
    slow_disk.clear()
    for stamp in range(20_000):
        recorder.put(stamp, [(channel, DATA)])
        if stamp == 10_000:
            slow_disk.set()
    recorder.close()
    with open_bag(recorder.path) as bag:
        found = gaps(bag)
        stamps = [stamp for _, stamp, _ in bag.messages()]
    assert recorder.messages == len(stamps)
    assert sum(int(gap['messages']) for gap in found) == recorder.lost == 20_000 - len(stamps)
    missing = set(range(20_000)) - set(stamps)
    for gap in found:
        told = set(range(int(gap['first_ns']), int(gap['last_ns']) + 1))
        assert told <= missing
        missing -= told
    assert not missing
    # each but the last ended when half of what waited was written
    assert len(found) <= 2 + 20_000 // 50


def test_what_no_bag_can_hold_is_told_in_it(tmp_path):
    with Recorder(BagWriter(tmp_path / 'run.mcap')) as recorder:
        channel = recorder.add_channel('/a', 'std_msgs/msg/UInt64')
        for stamp in (5, 3, 2, 6):
            recorder.put(stamp, [(channel, DATA), (channel, DATA)])
    with open_bag(recorder.path) as bag:
        (gap,) = gaps(bag)
    assert (recorder.messages, recorder.lost, gap['messages']) == (4, 4, '4')
    assert 'at 3 ns cannot follow one at 5 ns' in gap['reason']


def test_it_is_brought_to_the_disk_and_not_by_who_puts(tmp_path, monkeypatch):
    synced = []
    monkeypatch.setattr(output, '_sync', lambda file: synced.append(threading.current_thread()))
    with Recorder(BagWriter(tmp_path / 'run.mcap'), sync_period=0.01) as recorder:
        channel = recorder.add_channel('/a', 'std_msgs/msg/UInt64')
        recorder.put(0, [(channel, DATA)])
        until(lambda: len(synced) > 2)
    assert {thread.name for thread in synced} == {'bag sync', 'bag recorder'}
    # the whole file, at its end
    assert synced[-1].name == 'bag recorder'
    assert not [thread for thread in threading.enumerate() if thread.name == 'bag sync']
    synced.clear()
    with Recorder(BagWriter(tmp_path / 'other.mcap')) as recorder:
        recorder.put(0, [(recorder.add_channel('/a', 'std_msgs/msg/UInt64'), DATA)])
    assert not synced


def test_a_disk_that_cannot_be_synced_is_told_of_once(tmp_path, monkeypatch):
    calls = []

    def fail(file):
        calls.append(file)
        raise OSError(5, 'Input/output error')

    monkeypatch.setattr(output, '_sync', fail)
    recorder = Recorder(BagWriter(tmp_path / 'run.mcap'), sync_period=0.01)
    until(lambda: len(calls) > 3)
    assert list(recorder.news) == [
        (True, f'{recorder.path} cannot be brought to the disk: Input/output error')]
    monkeypatch.undo()
    recorder.close()
    with open_bag(recorder.path) as bag:
        assert bag.complete
