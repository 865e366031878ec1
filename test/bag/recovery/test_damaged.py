# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A bag that is damaged in the middle: what is intact before and behind, and what is missing."""

from bag_samples import sample_messages, TOPICS, write_sample
from dynsim_ros.bag.reader import open_bag
from dynsim_ros.bag.recovery.recover import recover
from mcap.opcode import Opcode
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer
import numpy as np
from other_readers import by_mcap, places
import pytest


@pytest.fixture
def whole(tmp_path):
    """Give the path of a bag, its bytes, and the messages in it."""
    path = tmp_path / 'run.mcap'
    messages = write_sample(path, 60, chunk_size=2000)
    return path, path.read_bytes(), messages


def in_chunk(content, number):
    """Return what is in a chunk of a file, as mcap reads it."""
    with open(content, 'rb') as stream:
        index = sorted(make_reader(stream).get_summary().chunk_indexes,
                       key=lambda index: index.chunk_start_offset)[number]
        return index.message_start_time, index.message_end_time


def test_a_chunk_is_damaged(whole):
    path, content, messages = whole
    chunks = places(content, Opcode.CHUNK)
    first_ns, last_ns = in_chunk(path, 3)
    start, end = chunks[3]
    damaged = bytearray(content)
    damaged[start + 100] ^= 0x10
    path.write_bytes(damaged)
    found = recover(path)
    (hole,) = found.holes
    read, told = by_mcap(path)
    missing = [message for message in messages if message not in read]
    assert read == [message for message in messages if message not in missing]
    assert (hole.start, hole.messages) == (start, len(missing)) and hole.end > end
    assert (hole.first_ns, hole.last_ns) == (missing[0][1], missing[-1][1]) == (first_ns, last_ns)
    assert len(missing) + told == len(messages)
    assert found.kept.read_bytes() == damaged
    assert str(hole).startswith(f'{len(missing)} messages from {first_ns * 1e-9:.3f} s to ')
    with open_bag(path) as bag:
        assert bag.complete and bag.metadata['missing_1']['messages'] == str(len(missing))
        assert bag.metadata['missing_1']['first_ns'] == str(first_ns)


@pytest.mark.parametrize('length', [1, 40, 3000])
def test_a_stretch_is_overwritten(whole, length):
    path, content, messages = whole
    start = places(content, Opcode.CHUNK)[2][0] + 20
    for filling in (bytes(length), np.random.default_rng(length).bytes(length)):
        path.write_bytes(content[:start] + filling + content[start + length:])
        found = recover(path)
        read, told = by_mcap(path)
        assert told == len(read)
        assert set(read) <= set(messages) and read == sorted(read, key=messages.index)
        assert read[0] == messages[0] and read[-1] == messages[-1]
        # the index at the end of the file tells what was there
        assert sum(hole.messages for hole in found.holes) == len(messages) - len(read)


@pytest.mark.parametrize('compression', ['zstd', 'none'])
def test_one_bit_anywhere(tmp_path, compression):
    """Never is a message other than it was, and whatever is missing is told of."""
    path = tmp_path / 'run.mcap'
    messages = write_sample(path, 20, chunk_size=1500, compression=compression)
    content = path.read_bytes()
    random = np.random.default_rng(7)
    for at in random.choice(len(content), 100, replace=False).tolist():
        damaged = bytearray(content)
        damaged[at] ^= 1 << int(random.integers(8))
        path.write_bytes(damaged)
        found = recover(path)
        read, told = by_mcap(path)
        assert told == len(read) == found.messages
        assert read == [message for message in messages if message in read], at
        missing = len(messages) - len(read)
        known = [hole.messages for hole in found.holes]
        assert None in known or sum(known) == missing, (at, known)
        # a channel's description may be what is lost, else no more than a chunk
        assert missing <= 45
        assert found.kept is None or found.kept.read_bytes() == damaged
        with open_bag(path) as bag:
            assert bag.complete and bag.count == len(read)
        for other in tmp_path.glob('*.damaged*'):
            other.unlink()


def test_the_index_alone_is_damaged(whole):
    path, content, messages = whole
    for opcode in (Opcode.MESSAGE_INDEX, Opcode.CHUNK_INDEX, Opcode.STATISTICS):
        start, _ = places(content, opcode)[1 if opcode != Opcode.STATISTICS else 0]
        damaged = bytearray(content)
        damaged[start + 20] ^= 0x01
        path.write_bytes(damaged)
        found = recover(path)
        assert not found.was_whole and found.holes == []
        assert by_mcap(path) == (messages, len(messages))
        with open(path, 'rb') as stream:
            assert sorted((channel.topic, message.log_time) for _, channel, message
                          in make_reader(stream).iter_messages(topics=['/sample/twist'])) == [
                (topic, stamp) for topic, stamp, _ in messages if topic == '/sample/twist']


def test_the_beginning_is_damaged(whole):
    path, content, messages = whole
    for end in (4, 12, 30):
        path.write_bytes(b'\xff' * end + content[end:])
        recover(path)
        assert by_mcap(path)[0] == messages


def test_what_describes_a_topic_is_damaged(whole):
    """It stands at the end of a finished file, too; in one that was cut off it is lost."""
    path, content, messages = whole
    start, end = places(content, Opcode.CHANNEL)[1]
    damaged = content[:start] + bytes(end - start) + content[end:]
    path.write_bytes(damaged)
    assert recover(path).messages == len(messages)
    path.write_bytes(damaged[:places(content, Opcode.DATA_END)[0][0]])
    found = recover(path)
    read, _ = by_mcap(path)
    assert read == [message for message in messages if message[0] != '/sample/twist']
    assert {hole.messages for hole in found.holes} == {None, 60}
    assert any('the description of channel 2 is damaged' in str(hole) for hole in found.holes)


@pytest.mark.parametrize('compression', list(CompressionType))
@pytest.mark.parametrize('chunking', [True, False])
def test_files_of_mcap_itself(tmp_path, chunking, compression):
    messages = sample_messages(50)
    path = tmp_path / 'a.mcap'
    with open(path, 'wb') as stream:
        writer = Writer(stream, chunk_size=2000, compression=compression, use_chunking=chunking)
        writer.start('ros2')
        channels = {}
        for topic, (type_name, _) in TOPICS.items():
            schema = writer.register_schema(type_name, 'ros2msg', b'')
            channels[topic] = writer.register_channel(topic, 'cdr', schema)
        for topic, stamp, data in messages:
            writer.add_message(channels[topic], stamp, data, stamp)
        writer.add_attachment(0, 0, 'x.txt', 'text/plain', b'x' * 50)
        writer.finish()
    content = path.read_bytes()
    assert recover(path).was_whole and path.read_bytes() == content
    (end, _), = places(content, Opcode.ATTACHMENT)
    for start in range(end // 3, end - 200, end // 7):
        path.write_bytes(content[:start] + b'\x5a' * 50 + content[start + 50:])
        found = recover(path)
        read, told = by_mcap(path)
        assert told == len(read) >= (30 if chunking else 97)
        # Outside chunks there are no checksums: what is in a message is taken as it stands.
        assert len(set(read) - set(messages)) <= (not chunking)
        known = [message for message in read if message in messages]
        assert known == sorted(known, key=messages.index)
        assert (found.kept is None) == (not found.holes)
        with open_bag(path) as bag:
            assert bag.attachments['x.txt'] == ('text/plain', b'x' * 50)
