# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recording on a disk that is full: a small one of its own where mounting is possible."""

import tempfile

from dynsim_ros.bag.reader import open_bag
from dynsim_ros.bag.recovery.recover import recover
from mcap.reader import make_reader
import pytest
from scene_topics import DIAGNOSTICS, POSE
from small_disk import can_mount, SizeLimit, SmallDisk

with tempfile.TemporaryDirectory() as FOLDER:
    DISKS = [SizeLimit, SmallDisk] if can_mount(FOLDER) else [SizeLimit]
ROOM = 150_000


@pytest.fixture(scope='module', params=DISKS)
def kind(request):
    return request.param


@pytest.fixture(scope='module')
def node(kind, start, tmp_path_factory):
    folder = tmp_path_factory.mktemp('node')
    (folder / 'runs').mkdir()
    return start('-p', 'record.enable:=true', folder=folder, within=kind.within)


@pytest.fixture(scope='module')
def client(node, connect):
    client = connect(node)
    client.listen({'sphere/pose': POSE, '/diagnostics': DIAGNOSTICS})
    client.more('sphere/pose', 5)
    yield client
    node.stop()


@pytest.fixture(scope='module')
def disk(kind, node, client):
    return kind(node)


def fill(disk, node, client):
    """Let the bag find no room any more, wait until that is told; return the bag."""
    client.record(True)
    path = disk.folder / client.record(True).message.removeprefix('recording already, to ')
    before = len(node.output)
    disk.fill(path, ROOM)
    client.configure({'rate': 1000.0})
    client.wait(lambda: 'recorder: ' in node.output[before:])
    assert f'{path.name} cannot be written: {disk.reason}' in node.output[before:]
    return path


def test_full_disk_that_has_room_again(disk, node, client):
    path = fill(disk, node, client)
    status = client.wait(lambda: (found := client.recorder_status()).level == b'\x02' and found)
    assert f'{path.name} cannot be written: {disk.reason}' in status.message
    values = {item.key: int(item.value) for item in status.values if item.key != 'file'}
    assert 0 < values['waiting'] < values['may wait'] and values['lost'] == 0
    client.more('sphere/pose', 20)
    disk.empty()
    client.wait(lambda: 'is written again' in node.output)
    client.wait(lambda: client.recorder_status().level == b'\x00')
    assert 'lost' not in client.record(False).message
    client.configure({'rate': 100.0})
    with open_bag(path) as bag:
        assert bag.complete
        times = [stamp for topic, stamp, _ in bag.messages() if topic == '/dynsim/sphere/pose']
    steps = {later - earlier for earlier, later in zip(times, times[1:])}
    # at 100 Hz, and at 1 kHz: none is missing
    assert steps == {10_000_000, 1_000_000}
    assert node.output.count('[ERROR] ') == node.output.count('cannot be written') > 0


def test_full_disk_to_the_end(disk, node, client):
    path = fill(disk, node, client)
    stopped = client.record(False)
    assert stopped.success and ' lost: ' in stopped.message
    assert f'is not finished: {disk.reason}; recover it when there is room' in node.output
    disk.empty()
    # what it holds comes out with a reader that does not need an end
    with open_bag(path) as bag:
        assert bag.problem and sum(1 for _ in bag.messages()) > 1000
    recover(path)
    # and the next one is a good one again
    assert client.record(True).success
    client.more('sphere/pose', 20)
    again = client.record(False).message
    assert 'lost' not in again
    with open(disk.folder / again.split(' in ')[1], 'rb') as stream:
        assert make_reader(stream).get_summary().statistics.message_count > 100
    client.configure({'rate': 100.0})
