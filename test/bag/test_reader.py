# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
from bag_samples import KINDS_OF_MCAP, sample_messages, TOPICS, write_foreign, write_sample
from dynsim_ros.bag.reader import BagError, open_bag
from dynsim_ros.messages.cdr import decode
from dynsim_ros.messages.definitions import definition
from dynsim_ros.messages.qos import LATCHED, Qos
from mcap.writer import CompressionType, Writer
from mcap_ros2.writer import Writer as Ros2Writer
import pytest
from rosbags.interfaces import Qos as RosbagsQos
from rosbags.interfaces import QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Writer as RosbagsWriter
import yaml

FOREVER = QosTime(9223372036, 854775807)


@pytest.fixture
def whole(tmp_path):
    """Give the bytes of a bag and the messages in it."""
    messages = write_sample(tmp_path / 'whole.mcap', chunk_size=3000)
    return (tmp_path / 'whole.mcap').read_bytes(), messages


def test_everything_about_our_own(tmp_path):
    path = tmp_path / 'run.mcap'
    messages = write_sample(path)
    with open_bag(path) as bag:
        assert (bag.start_ns, bag.end_ns, bag.count) == (0, 990_000_000, 201)
        assert bag.complete and bag.problem is None
        assert bag.metadata == {'settings': {'rate': '100', 'integrator': 'rk4'}}
        assert bag.attachments == {'scene.yaml': ('application/yaml', b'gravity: 9.81\n')}
        for topic, (type_name, qos) in TOPICS.items():
            channel = bag.channels[topic]
            assert (channel.type_name, channel.encoding, channel.qos) == (type_name, 'cdr', qos)
            assert channel.definition == definition(type_name).text
            assert channel.type_hash == definition(type_name).type_hash
        assert [channel.count for channel in bag.channels.values()] == [100, 100, 1]
        assert list(bag.messages()) == messages
        part = list(bag.messages(['/sample/pose'], 100_000_000, 200_000_000))
        assert part == [item for item in messages
                        if item[0] == '/sample/pose' and 100_000_000 <= item[1] <= 200_000_000]
        assert len(part) == 11
        both = zip(bag.messages(), bag.messages(), strict=True)
        assert all(one == other for one, other in both)


@pytest.mark.parametrize('version', [8, 9])
@pytest.mark.parametrize('mode', list(CompressionMode))
def test_rosbags_folders(tmp_path, mode, version):
    qos = RosbagsQos(QosHistory.KEEP_LAST, 1, QosReliability.RELIABLE,
                     QosDurability.TRANSIENT_LOCAL, FOREVER, FOREVER, QosLiveliness.AUTOMATIC,
                     FOREVER, False)
    messages = sample_messages()
    writer = RosbagsWriter(tmp_path / 'bag', version=version, storage_plugin=StoragePlugin.MCAP)
    writer.set_compression(mode, CompressionFormat.ZSTD)
    with writer:
        connections = {topic: writer.add_connection(
            topic, type_name, msgdef=definition(type_name).text,
            rihs01=definition(type_name).type_hash,
            offered_qos_profiles=[qos] if topic == '/sample/epoch' else [])
            for topic, (type_name, _) in TOPICS.items()}
        for topic, stamp, data in messages:
            writer.write(connections[topic], stamp, data)
    with open_bag(tmp_path / 'bag') as bag:
        assert list(bag.messages()) == messages and bag.count == len(messages)
        assert bag.channels['/sample/epoch'].qos == LATCHED
        assert bag.channels['/sample/pose'].qos is None
        assert bag.complete


def test_folder_of_several_files(tmp_path):
    messages = sample_messages(30)
    parts = [messages[:20], messages[20:45], messages[45:]]
    names = []
    for number, part in enumerate(parts):
        names.append(f'bag_{number}.mcap')
        write_foreign(tmp_path / names[-1], part, compression=CompressionType.NONE)
    (tmp_path / 'metadata.yaml').write_text(yaml.safe_dump({'rosbag2_bagfile_information': {
        'version': 9, 'storage_identifier': 'mcap', 'relative_file_paths': names,
        'compression_format': '', 'compression_mode': ''}}))
    with open_bag(tmp_path) as bag:
        assert list(bag.messages()) == messages and bag.count == len(messages)
    content = (tmp_path / names[1]).read_bytes()
    (tmp_path / names[1]).write_bytes(content[:len(content) // 2])
    with open_bag(tmp_path) as bag:
        assert bag.problem.startswith('bag_1.mcap: the file ends in the middle of a ')
        assert bag.count < len(messages)


def test_mcap_ros2_files(tmp_path):
    path = tmp_path / 'a.mcap'
    with open(path, 'wb') as stream:
        writer = Ros2Writer(stream)
        schema = writer.register_msgdef('std_msgs/UInt64', 'uint64 data')
        for number in range(10):
            writer.write_message('/count', schema, {'data': number}, log_time=number * 1000,
                                 publish_time=number)
        writer.finish()
    with open_bag(path) as bag:
        assert bag.channels['/count'].type_name == 'std_msgs/msg/UInt64'
        assert [(stamp, decode('std_msgs/msg/UInt64', data)['data'])
                for _, stamp, data in bag.messages()] == [
                    (number * 1000, number) for number in range(10)]


@pytest.mark.parametrize('compression', list(CompressionType))
@pytest.mark.parametrize('options', KINDS_OF_MCAP, ids=str)
def test_any_kind_of_mcap(tmp_path, options, compression):
    messages = sample_messages(50)
    write_foreign(tmp_path / 'a.mcap', messages, compression=compression, **options)
    with open_bag(tmp_path / 'a.mcap') as bag:
        assert list(bag.messages()) == messages and bag.count == len(messages)
        assert (bag.start_ns, bag.end_ns) == (0, 490_000_000)
        assert bag.complete and bag.metadata == {'note': {'a': 'b'}}
        assert bag.attachments == {'x.txt': ('text/plain', b'x')}


def test_several_channels_of_one_topic(tmp_path):
    messages = sample_messages(50)
    write_foreign(tmp_path / 'a.mcap', messages,
                  [LATCHED.offered_qos_profiles(), Qos().offered_qos_profiles()])
    with open_bag(tmp_path / 'a.mcap') as bag:
        assert list(bag.messages()) == messages
        assert bag.channels['/sample/pose'].count == 50


def test_one_topic_with_two_types(tmp_path):
    with open(tmp_path / 'a.mcap', 'wb') as stream:
        writer = Writer(stream)
        writer.start()
        for name in ('std_msgs/msg/UInt64', 'std_msgs/msg/Int64'):
            schema = writer.register_schema(name, 'ros2msg', b'uint64 data')
            writer.add_message(writer.register_channel('/a', 'cdr', schema), 1, b'x', 1)
        writer.finish()
    with open_bag(tmp_path / 'a.mcap') as bag:
        assert bag.count == len(list(bag.messages())) == 1
        assert bag.problem == ('/a is std_msgs/msg/UInt64 and also std_msgs/msg/Int64: the latter '
                               'is left out')


@pytest.mark.parametrize('chunking', [True, False])
def test_messages_in_disorder_are_sorted(tmp_path, chunking):
    messages = sample_messages(60)
    mixed = messages[70:90] + messages[::2] + messages[1::2][::-1]
    write_foreign(tmp_path / 'a.mcap', mixed, use_chunking=chunking)
    with open_bag(tmp_path / 'a.mcap') as bag:
        read = list(bag.messages())
    assert read == sorted(mixed, key=lambda message: message[1])


def test_every_cut_gives_what_lies_before_it(tmp_path, whole):
    content, messages = whole
    path = tmp_path / 'cut.mcap'
    before = 0
    for end in [*range(8, len(content), 211), len(content) - 9]:
        path.write_bytes(content[:end])
        with open_bag(path) as bag:
            read = list(bag.messages())
            assert read == messages[:len(read)] and bag.count == len(read) >= before
            assert not bag.complete and '\n' not in bag.problem
            before = len(read)
            if read:
                assert bag.problem.endswith(
                    f': {len(read)} messages up to {read[-1][1] * 1e-9:.2f} s could be read')
            else:
                assert bag.problem.endswith(': no message could be read')
    assert before == len(messages)


def test_a_damaged_chunk_is_left_out(tmp_path, whole):
    content, messages = whole
    path = tmp_path / 'damaged.mcap'
    middle = content.find(b'zstd', content.find(b'zstd') + 1) + 60
    damaged = content[:middle] + bytes(8) + content[middle + 8:]
    path.write_bytes(damaged)
    with open_bag(path) as bag:
        assert bag.complete
        read = list(bag.messages())
        assert 0 < len(read) < len(messages) and set(read) < set(messages)
        assert 'is damaged' in bag.problem and not bag.complete
    path.write_bytes(damaged[:-100])
    with open_bag(path) as bag:
        assert list(bag.messages()) == read
        assert '1 damaged record(s) left out' in bag.problem


@pytest.mark.parametrize(('content', 'part'), [
    (b'', 'is empty'), (b'gravity: 9.81\n', 'is not an MCAP file'),
    (b'\x89MCAP', 'is not an MCAP file')])
def test_what_is_no_bag(tmp_path, content, part):
    path = tmp_path / 'a.mcap'
    path.write_bytes(content)
    with pytest.raises(BagError) as caught:
        open_bag(path)
    assert str(caught.value) == f'{path} {part}'


def test_what_is_not_there(tmp_path):
    with pytest.raises(BagError, match=r'nothing.mcap: No such file or directory$'):
        open_bag(tmp_path / 'nothing.mcap')
    with pytest.raises(BagError, match='is a folder without metadata.yaml'):
        open_bag(tmp_path)


@pytest.mark.parametrize(('text', 'part'), [
    ('a: [', 'does not describe'), ('a: 1', 'does not describe'), ('3', 'does not describe'),
    ('rosbag2_bagfile_information: {storage_identifier: sqlite3, relative_file_paths: [a.db3]}',
     "stored as 'sqlite3'"),
    ('rosbag2_bagfile_information: {storage_identifier: mcap, relative_file_paths: []}',
     'names no file'),
    ('rosbag2_bagfile_information: {storage_identifier: mcap, relative_file_paths: [a.mcap]}',
     'a.mcap: No such file'),
    ('rosbag2_bagfile_information: {storage_identifier: mcap, relative_file_paths: [b.zstd]}',
     'cannot be decompressed'),
])
def test_folders_that_are_no_bags(tmp_path, text, part):
    (tmp_path / 'metadata.yaml').write_text(text)
    (tmp_path / 'b.zstd').write_bytes(b'abc' * 100)
    with pytest.raises(BagError, match=part) as caught:
        open_bag(tmp_path)
    assert '\n' not in str(caught.value)
