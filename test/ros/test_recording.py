# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recording as it is asked for, by parameter and by service."""

from dynsim_ros.messages.cdr import decode
from dynsim_ros.messages.commands import PARAMETER
from live_node import age
from mcap.reader import make_reader
import pytest
from scene_topics import DIAGNOSTICS, POSE


@pytest.fixture(scope='module')
def node(start):
    return start('-p', 'record.enable:=true')


@pytest.fixture(scope='module')
def client(node, connect):
    client = connect(node)
    client.listen({'sphere/pose': POSE, '/diagnostics': DIAGNOSTICS})
    client.more('sphere/pose', 5)
    return client


@pytest.fixture(autouse=True)
def recording(client):
    client.pause(False)
    client.record(True)


def summary(path):
    """Return the summary of a bag, which only a finished one has."""
    with open(path, 'rb') as stream:
        found = make_reader(stream).get_summary()
    assert found is not None
    return found


def test_stop_and_start_name_the_file(node, client):
    response = client.record(False)
    assert response.success
    count, name = response.message.split(' messages in ')
    assert summary(node.folder / name).statistics.message_count == int(count) > 0
    started = client.record(True)
    assert started.success
    assert started.message != name and (node.folder / started.message).is_file()


def test_changes_of_other_parameters_are_recorded(node, client):
    client.record(False)
    name = client.record(True).message
    assert client.configure({'real_time_factor': 0.5})[0].successful
    assert client.configure({'real_time_factor': 1.0})[0].successful
    client.record(False)
    with open(node.folder / name, 'rb') as stream:
        found = [decode(PARAMETER, message.data) for _, _, message in make_reader(
            stream).iter_messages(topics=['/dynsim/parameter_command'])]
    assert [(change['name'], change['value']['double_value']) for change in found] == [
        ('real_time_factor', 0.5), ('real_time_factor', 1.0)]


def test_twice_is_refused_and_changes_nothing(node, client):
    again = client.record(True)
    assert not again.success
    name = again.message.removeprefix('recording already, to ')
    assert client.record(False).message.endswith(f' messages in {name}')
    nothing = client.record(False)
    assert (nothing.success, nothing.message) == (False, 'not recording')


def test_reset_begins_a_new_file(node, client):
    before = set(node.bags)
    client.more('sphere/pose', 3)
    client.reset()
    client.more('sphere/pose', 3)
    client.pause()
    client.reset()
    stopped = client.record(False).message
    first, second = sorted(set(node.bags) - before, key=age)
    assert stopped.endswith(str(second.relative_to(node.folder)))
    for path in (first, second):
        statistics = summary(path).statistics
        assert statistics.message_start_time == 0
        with open(path, 'rb') as stream:
            (record,) = [record.metadata for record in make_reader(stream).iter_metadata()
                         if record.name == 'dynsim_ros']
        assert record['start_tick'] == '0'
    # the second was reset while paused: it holds the initial state alone
    assert summary(second).statistics.message_end_time == 0


def test_directory_can_change_and_has_to_be_writable(node, client):
    client.record(False)
    (node.folder / 'file').write_text('no folder')
    for directory, reason in (('file', 'File exists'), ('file/below', 'Not a directory'),
                              ('/proc/nowhere', 'No such file or directory')):
        assert client.configure({'record.directory': directory})[0].successful
        response = client.record(True)
        assert not response.success
        assert response.message == (f'record.directory: {directory} cannot be written to: '
                                    f'{reason}; choose another folder')
    assert client.set_group({'record.directory': 'other/place',
                             'record.compression': 'lz4'}).successful
    assert client.record(True).message.startswith('other/place/sphere_on_spring_')
    client.more('sphere/pose', 20)
    path = node.folder / client.record(False).message.split(' in ')[1]
    assert {index.compression for index in summary(path).chunk_indexes} == {'lz4'}
    client.set_group({'record.directory': 'runs', 'record.compression': 'zstd'})


def test_a_reset_that_cannot_record_says_so_and_goes_on(node, client):
    client.configure({'record.directory': '/proc/nowhere'})
    before = len(node.output)
    assert client.reset().success
    client.more('sphere/pose', 3)
    assert '[ERROR]' in node.output[before:]
    assert 'record.directory: /proc/nowhere cannot be written to' in node.output[before:]
    assert client.recorder_status().message == 'not recording'
    client.configure({'record.directory': 'runs'})


def test_all_is_finished_in_the_end(node, client):
    client.more('sphere/pose', 3)
    assert node.stop().count('[INFO]') > 2
    for path in node.bags:
        assert summary(path).statistics.message_count > 0
