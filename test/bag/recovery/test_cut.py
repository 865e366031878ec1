# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A bag that is cut off anywhere: everything up to the last complete record comes back."""

from bag_samples import sample_messages, TOPICS, write_sample
from dynsim_ros.bag.reader import open_bag
from dynsim_ros.bag.records import HEAD, MAGIC
from dynsim_ros.bag.recovery.recover import recover
from dynsim_ros.bag.writer import BagWriter
from mcap.opcode import Opcode
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer
from other_readers import by_mcap, by_rosbags, places
import pytest


@pytest.mark.parametrize('compression', ['zstd', 'lz4', 'none'])
def test_every_byte_of_a_chunk(tmp_path, compression):
    messages = write_sample(tmp_path / 'whole.mcap', 12, chunk_size=450, compression=compression)
    content = (tmp_path / 'whole.mcap').read_bytes()
    chunks = places(content, Opcode.CHUNK)
    assert len(chunks) > 2
    start, end = chunks[1]
    path = tmp_path / 'cut.mcap'
    path.write_bytes(content[:start])
    before = recover(path).messages
    path.write_bytes(content[:end])
    after = recover(path).messages
    assert 0 < before < after
    counts = []
    for cut in range(start, end + 1):
        path.write_bytes(content[:cut])
        found = recover(path)
        read, told = by_mcap(path)
        assert read == messages[:found.messages] and told == found.messages
        assert (found.kept, len(found.holes)) == (None, 0 if cut in (start, end) else 1)
        counts.append(found.messages)
    assert counts == sorted(counts) and set(counts) <= set(range(before, after + 1))
    assert (counts[0], counts[-1]) == (before, after)
    if compression == 'none':
        # every message that is there to its last byte
        assert set(counts) == set(range(before, after + 1))
    assert sorted(path.name for path in tmp_path.iterdir()) == ['cut.mcap', 'whole.mcap']


def test_any_place_in_a_whole_file(tmp_path):
    messages = write_sample(tmp_path / 'whole.mcap', 40, chunk_size=3000)
    content = (tmp_path / 'whole.mcap').read_bytes()
    path = tmp_path / 'cut.mcap'
    header_end = len(MAGIC) + HEAD.size + HEAD.unpack_from(content, len(MAGIC))[1]
    counts = []
    for cut in [*range(header_end, len(content), 199), len(content) - 1, len(content)]:
        path.write_bytes(content[:cut])
        found = recover(path)
        read, told = by_mcap(path)
        assert read == messages[:found.messages] and told == len(read)
        assert by_rosbags(path) == read
        with open_bag(path) as bag:
            assert bag.complete and list(bag.messages()) == read
        assert found.was_whole == (cut == len(content))
        counts.append(found.messages)
        # once is enough
        assert recover(path).was_whole
    assert counts == sorted(counts) and counts[-1] == len(messages)


def test_what_describes_the_run_comes_back_too(tmp_path):
    path = tmp_path / 'run.mcap'
    write_sample(path, 40, chunk_size=3000)
    content = path.read_bytes()
    path.write_bytes(content[:places(content, Opcode.CHUNK)[2][0] + 100])
    recover(path)
    with open_bag(path) as bag:
        assert bag.attachments == {'scene.yaml': ('application/yaml', b'gravity: 9.81\n')}
        assert bag.metadata['settings'] == {'rate': '100', 'integrator': 'rk4'}
        assert bag.metadata['recovered']['missing'] == '1'
        assert bag.metadata['missing_1']['messages'] == 'unknown'
        assert 'the file ends in the middle of a chunk' in bag.metadata['missing_1']['reason']
        assert [(channel.type_name, channel.qos) for channel in bag.channels.values()] == list(
            TOPICS.values())


@pytest.mark.parametrize('compression', list(CompressionType))
@pytest.mark.parametrize('options', [{}, {'use_chunking': False}], ids=str)
def test_files_of_mcap_itself(tmp_path, options, compression):
    messages = sample_messages(50)
    path = tmp_path / 'cut.mcap'
    with open(path, 'wb') as stream:
        writer = Writer(stream, chunk_size=2000, compression=compression, **options)
        writer.start('ros2', 'another program')
        channels = {}
        for topic, (type_name, _) in TOPICS.items():
            schema = writer.register_schema(type_name, 'ros2msg', b'# as it was')
            channels[topic] = writer.register_channel(topic, 'cdr', schema)
        for topic, stamp, data in messages:
            writer.add_message(channels[topic], stamp, data, stamp + 5)
        writer.finish()
    content = path.read_bytes()
    (end, _), = places(content, Opcode.DATA_END)
    for cut in range(end * 2 // 3, end, end // 11):
        path.write_bytes(content[:cut])
        found = recover(path)
        read, told = by_mcap(path)
        assert read == messages[:len(read)] and told == len(read) == found.messages > 40
        assert found.kept is None
        with open(path, 'rb') as stream:
            reader = make_reader(stream)
            assert reader.get_header().library == 'another program'
            assert {message.publish_time - message.log_time
                    for _, _, message in reader.iter_messages()} == {5}
            assert {schema.data for schema, _, _ in reader.iter_messages()} == {b'# as it was'}


def test_a_bag_without_a_message(tmp_path):
    path = tmp_path / 'run.mcap'
    with BagWriter(path) as writer:
        writer.add_channel('/a', 'std_msgs/msg/UInt64')
    content = path.read_bytes()
    path.write_bytes(content[:-60])
    found = recover(path)
    assert (found.messages, found.first_ns, found.holes) == (0, None, [])
    assert by_mcap(path) == ([], 0)
