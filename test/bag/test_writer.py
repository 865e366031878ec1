# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
import resource
import subprocess
import sys

from bag_samples import sample_messages, TOPICS, write_sample
from dynsim_ros.bag.reader import open_bag
from dynsim_ros.bag.writer import BagWriter
from dynsim_ros.messages.cdr import decode
from dynsim_ros.messages.definitions import definition
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
import pytest
from rosbags.interfaces import Qos
from rosbags.rosbag2.storage_mcap import McapReader
import yaml

COMPRESSIONS = ('zstd', 'lz4', 'none')


@pytest.fixture(params=COMPRESSIONS)
def bag(request, tmp_path):
    """Give the path of a bag and the messages in it."""
    path = tmp_path / 'run.mcap'
    return path, write_sample(path, compression=request.param, chunk_size=5000)


def test_mcap_reads_the_same_bytes(bag):
    path, messages = bag
    with open(path, 'rb') as stream:
        reader = make_reader(stream, validate_crcs=True)
        assert (reader.get_header().profile, reader.get_header().library) == (
            'ros2', 'dynsim_ros test')
        read = [(channel.topic, message.log_time, message.data)
                for _, channel, message in reader.iter_messages()]
        assert read == messages
        assert all(message.log_time == message.publish_time
                   for _, _, message in reader.iter_messages())
        summary = reader.get_summary()
        assert summary.statistics.message_count == len(messages)
        assert summary.statistics.chunk_count == len(summary.chunk_indexes) > 3
        assert [attached.data for attached in reader.iter_attachments()] == [b'gravity: 9.81\n']
        assert [record.metadata for record in reader.iter_metadata()] == [
            {'rate': '100', 'integrator': 'rk4'}]


def test_channels_are_as_ros2_bag_wants_them(bag):
    with open(bag[0], 'rb') as stream:
        summary = make_reader(stream).get_summary()
    assert {channel.topic for channel in summary.channels.values()} == set(TOPICS)
    for channel in summary.channels.values():
        type_name, qos = TOPICS[channel.topic]
        schema = summary.schemas[channel.schema_id]
        assert (channel.message_encoding, schema.encoding) == ('cdr', 'ros2msg')
        assert schema.name == type_name
        assert schema.data.decode() == definition(type_name).text
        assert channel.metadata['topic_type_hash'] == definition(type_name).type_hash
        (profile,) = yaml.safe_load(channel.metadata['offered_qos_profiles'])
        assert len(profile) == 9 and profile['durability'] == qos.durability


def test_mcap_ros2_decodes_it(bag):
    with open(bag[0], 'rb') as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        decoded = [item.decoded_message
                   for item in reader.iter_decoded_messages(topics='/sample/pose')]
    assert [message.pose.position.z for message in decoded] == [
        decode('geometry_msgs/msg/PoseStamped', data)['pose']['position']['z']
        for topic, _, data in bag[1] if topic == '/sample/pose']
    assert {message.header.frame_id for message in decoded} == {'world'}


def test_rosbags_reads_the_same_bytes(bag):
    path, messages = bag
    reader = McapReader(path)
    reader.open()
    try:
        found = [(connection.topic, stamp, bytes(data)) for connection, stamp, data
                 in reader.messages(reader.connections, 0, 2 ** 62)]
        assert found == messages
        for connection in reader.connections:
            (qos,) = connection.ext.offered_qos_profiles
            assert isinstance(qos, Qos)
            assert qos.durability.name.lower() == TOPICS[connection.topic][1].durability
    finally:
        reader.close()


def test_never_overwrites(tmp_path):
    path = tmp_path / 'run.mcap'
    path.write_bytes(b'precious')
    with pytest.raises(FileExistsError):
        BagWriter(path)
    assert path.read_bytes() == b'precious'


def test_time_does_not_go_back(tmp_path):
    with BagWriter(tmp_path / 'run.mcap') as writer:
        channel = writer.add_channel('/a', 'std_msgs/msg/UInt64')
        writer.write(channel, 5, b'\0\1\0\0' + bytes(8))
        with pytest.raises(ValueError, match='at 4 ns cannot follow one at 5 ns'):
            writer.write(channel, 4, b'\0\1\0\0' + bytes(8))
        with pytest.raises(ValueError, match='-1 ns'):
            writer.write(channel, -1, b'\0\1\0\0' + bytes(8))
        assert writer.message_count == 1


def test_refusals(tmp_path):
    with pytest.raises(ValueError, match="'bz2' is unknown: use one of zstd, lz4, none"):
        BagWriter(tmp_path / 'a.mcap', compression='bz2')
    with pytest.raises(ValueError, match='chunk size 0'):
        BagWriter(tmp_path / 'a.mcap', chunk_size=0)
    with BagWriter(tmp_path / 'b.mcap') as writer:
        with pytest.raises(ValueError, match="named 'rosbag2'"):
            writer.add_metadata('rosbag2', {})
    writer.close()
    with pytest.raises(ValueError, match='b.mcap is closed'):
        writer.flush()


def test_an_empty_bag_is_a_whole_file(tmp_path):
    path = tmp_path / 'run.mcap'
    with BagWriter(path) as writer:
        writer.add_channel('/a', 'std_msgs/msg/UInt64')
    with open(path, 'rb') as stream:
        summary = make_reader(stream).get_summary()
    assert summary.statistics.message_count == 0 and summary.channels[1].topic == '/a'


KILLED = """
import os, signal, sys
from bag_samples import sample_messages, TOPICS
from dynsim_ros.bag.writer import BagWriter
writer = BagWriter(sys.argv[1])
channels = {topic: writer.add_channel(topic, *what) for topic, what in TOPICS.items()}
for topic, stamp, data in sample_messages(5000, 1_000_000):
    writer.write(channels[topic], stamp, data)
os.kill(os.getpid(), signal.SIGKILL)
"""


def test_little_is_lost_when_killed(tmp_path):
    path = tmp_path / 'run.mcap'
    process = run_python(KILLED, path)
    assert process.returncode == -9
    with open_bag(path) as bag:
        read = list(bag.messages())
        assert read == sample_messages(5000, 1_000_000)[:len(read)]
        assert len(read) > 9000
        assert bag.problem.startswith('the file was not finished: ')


FULL = """
import resource, sys
from bag_samples import sample_messages, TOPICS
from dynsim_ros.bag.writer import BagWriter
limit = lambda size: resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY))
limit(60_000)
writer = BagWriter(sys.argv[1], compression='none', chunk_size=7000)
channels = {topic: writer.add_channel(topic, *what) for topic, what in TOPICS.items()}
failures = 0
for topic, stamp, data in sample_messages(1000):
    while True:
        try:
            writer.write(channels[topic], stamp, data)
            break
        except OSError as error:
            failures += 1
            if failures == 3:
                print(writer.message_count, error.strerror)
                if len(sys.argv) > 2:
                    limit(10 ** 9)
                else:
                    try:
                        writer.close()
                    except OSError:
                        print(writer.message_count)
                    sys.exit()
writer.close()
print(writer.message_count)
"""


def test_a_full_disk_leaves_what_was_written(tmp_path):
    path = tmp_path / 'run.mcap'
    before, after = run_python(FULL, path).stdout.splitlines()
    pending = int(before.split()[0]) - int(after)
    assert before.endswith(' File too large') and pending > 0
    assert path.stat().st_size < 60_000
    with open_bag(path) as bag:
        assert bag.count == int(after) > 100
        assert list(bag.messages()) == sample_messages(1000)[:bag.count]
        assert bag.problem.startswith('the file was not finished: ')


def test_it_goes_on_where_it_was_when_there_is_room_again(tmp_path):
    path = tmp_path / 'run.mcap'
    assert run_python(FULL, path, 'room').stdout.splitlines()[1] == '2001'
    with open(path, 'rb') as stream:
        reader = make_reader(stream, validate_crcs=True)
        assert [(channel.topic, message.log_time, message.data)
                for _, channel, message in reader.iter_messages()] == sample_messages(1000)
    with open_bag(path) as bag:
        assert bag.complete


def test_never_follows_a_link(tmp_path):
    path, target = tmp_path / 'run.mcap', tmp_path / 'elsewhere' / 'precious'
    target.parent.mkdir()
    path.symlink_to(target)
    with pytest.raises(FileExistsError):
        BagWriter(path)
    assert not target.exists()


def test_a_bag_that_could_not_be_described_leaves_nothing(tmp_path):
    writer = BagWriter(tmp_path / 'run.mcap')
    writer.discard()
    assert list(tmp_path.iterdir()) == []


def test_it_is_told_when_the_file_is_deleted(tmp_path):
    path = tmp_path / 'run.mcap'
    writer = BagWriter(path)
    channel = writer.add_channel('/a', 'std_msgs/msg/UInt64')
    path.unlink()
    writer.write(channel, 0, b'\0\1\0\0' + bytes(8))
    with pytest.raises(OSError, match='it has been deleted'):
        writer.close()


def run_python(code, *arguments):
    """Run code in a process of its own that may import from test/."""
    assert resource.getrlimit(resource.RLIMIT_FSIZE)[0] == resource.RLIM_INFINITY
    code = f'import sys\nsys.path[:0] = {sys.path!r}\n{code}'
    return subprocess.run([sys.executable, '-c', code, *map(str, arguments)],
                          capture_output=True, text=True, timeout=60)
