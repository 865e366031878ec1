# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bags damaged in every way: recovery ends soon, takes little memory and makes up nothing."""

from collections import Counter
import os
import struct
import time
import tracemalloc
import zlib

from bag_samples import write_sample
from dynsim_ros.bag.reader import open_bag
from dynsim_ros.bag.records import HEAD, MAGIC
from dynsim_ros.bag.recovery.recover import recover
from dynsim_ros.bag.sources import BagError
import lz4.frame
from mcap.opcode import Opcode
import numpy as np
from other_readers import by_mcap, by_rosbags, places
import pytest
import zstandard

# How many damaged files; `make fuzz-bag` tries more.
ROUNDS = int(os.environ.get('DYNSIM_FUZZ_ROUNDS', '25'))


def damaged(content, random):
    """Return bytes damaged in one to four places."""
    content = bytearray(content)
    for _ in range(int(random.integers(1, 5))):
        at = int(random.integers(len(content)))
        length = int(random.choice([1, 3, 40, 300, 2000]))
        end = min(at + length, len(content))
        kind = random.integers(5)
        if kind == 0:
            content[at:end] = bytes(end - at)
        elif kind == 1:
            content[at:end] = random.bytes(end - at)
        elif kind == 2:
            content[at:end] = b''
        elif kind == 3:
            content[at:at] = random.bytes(length)
        else:
            other = int(random.integers(len(content)))
            content[at:at] = content[other:other + length]
    return bytes(content)


@pytest.mark.parametrize('compression', ['zstd', 'lz4', 'none'])
def test_what_comes_back_is_what_was_there(tmp_path, compression):
    path = tmp_path / 'run.mcap'
    messages = Counter(write_sample(path, 40, chunk_size=1500, compression=compression))
    content = path.read_bytes()
    # The end tells what is described at the beginning; without it, that has no checksum.
    (_, start), = places(content, Opcode.HEADER)
    (end, _), = places(content, Opcode.DATA_END)
    random = np.random.default_rng(len(compression))
    for number in range(ROUNDS):
        path.write_bytes(
            content[:start] + damaged(content[start:end], random) + content[end:])
        found = recover(path)
        read, told = by_mcap(path)
        assert told == len(read) == found.messages, number
        # a stretch that was copied may hold some of them twice
        assert set(read) <= set(messages), number
        lost = (messages - Counter(read)).total()
        assert not lost or found.holes, number
        assert Counter(by_rosbags(path)) == Counter(read)
        with open_bag(path) as bag:
            assert bag.complete and bag.count == told
        for other in tmp_path.glob('*.damaged*'):
            other.unlink()


def test_channel_that_is_nonsense_in_one_of_two_places(tmp_path):
    """Neither has a checksum where the summary is damaged elsewhere: the sound one counts."""
    path = tmp_path / 'run.mcap'
    messages = write_sample(path, 40, chunk_size=1500)
    content = bytearray(path.read_bytes())
    at = content.index(b'}\n  avoid_ros_namespace_conventions')
    content[at] = ord('=')
    (start, _), = places(content, Opcode.STATISTICS)
    content[start + HEAD.size] ^= 1
    path.write_bytes(content)
    assert not recover(path).holes
    assert Counter(by_rosbags(path)) == Counter(messages)


def chunk(compression, data, size, crc=0):
    """Return a chunk that says that it holds so many bytes."""
    content = struct.pack('<QQQI', 0, 9, size, crc) + struct.pack('<I', len(compression))
    content += compression.encode() + struct.pack('<Q', len(data)) + data
    return HEAD.pack(Opcode.CHUNK, len(content)) + content


def hostile():
    """Yield names and contents of files made to take for ever, or all memory."""
    many = 64 * 1024 * 1024
    yield 'a chunk of 2^63 bytes', chunk('zstd', b'x' * 100, 2 ** 63)
    yield 'one of 2^64 - 1', chunk('', b'', 2 ** 64 - 1)
    yield 'a record that ends nowhere', HEAD.pack(Opcode.SCHEMA, 2 ** 64 - 1) + bytes(1000)
    for compression, compress in (('zstd', zstandard.compress), ('lz4', lz4.frame.compress)):
        data = bytes(many)
        yield f'zeros, {compression}', chunk(compression, compress(data), many, zlib.crc32(data))
        yield f'more than it says, {compression}', chunk(compression, compress(data), 1000)
    yield 'heads of records alone', b''.join(
        HEAD.pack(opcode, 2 ** 31) for opcode in range(1, 16)) * 4000
    yield 'chunks in chunks', b''.join(
        HEAD.pack(Opcode.CHUNK, 500_000 - 100 * i) + bytes(91) for i in range(4000))
    yield 'messages that are too short', HEAD.pack(Opcode.MESSAGE, 3) * 40_000
    yield 'many small ones', (HEAD.pack(Opcode.MESSAGE_INDEX, 6) + bytes(6)) * 20_000
    yield 'noise', np.random.default_rng(1).bytes(600_000)
    yield 'zeros', bytes(600_000)
    yield 'footer with nonsense', HEAD.pack(Opcode.FOOTER, 20) + b'\xff' * 20 + MAGIC
    yield 'nothing', b''
    yield 'the end alone', MAGIC


@pytest.mark.parametrize(('name', 'body'), [
    pytest.param(name, body, id=name) for name, body in hostile()])
def test_time_and_memory_are_bounded(tmp_path, name, body):
    path = tmp_path / 'a.mcap'
    with open(path, 'wb') as stream:
        header = struct.pack('<II', 0, 0)
        stream.write(MAGIC + HEAD.pack(Opcode.HEADER, len(header)) + header + body)
    begin = time.process_time()
    tracemalloc.start()
    try:
        found = recover(path)
        assert found.messages == 0
    except BagError as error:
        assert '\n' not in str(error)
    finally:
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    assert by_mcap(path)[0] == []
    # 64 MiB unpacked, and that once more on the way
    assert peak < 300e6
    assert time.process_time() - begin < 30.0
