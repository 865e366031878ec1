# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Messages by the index of a chunk, which may be wrong, beside a walk from record to record."""

import random
import subprocess
import sys

from bag_samples import sample_messages, write_foreign, write_sample
from dynsim_ros.bag.load_messages import indexed, walked
from dynsim_ros.bag.reader import open_bag
from dynsim_ros.bag.records import HEAD, open_chunk
import numpy as np
import pytest


def first_chunk(path):
    """Return records and message index of the first chunk of a bag."""
    with open_bag(path) as bag:
        (source, _), = bag.files()
        block = source.index.blocks[0]
        source.stream.seek(block.start)
        content = source.stream.read(block.end - block.start)
        return open_chunk(content[HEAD.size:]), source.stream.read(block.index_size)


@pytest.fixture(params=[write_sample, write_foreign], ids=['ours', 'mcap'])
def chunk(request, tmp_path):
    """Return records and index: of ours, and of one that declares channels among its messages."""
    if request.param is write_sample:
        write_sample(tmp_path / 'a.mcap', 20)
    else:
        write_foreign(tmp_path / 'a.mcap', sample_messages(20), chunk_size=10 ** 6)
    return first_chunk(tmp_path / 'a.mcap')


def as_walked(records, index):
    """Tell whether the index gives what a walk finds; None where it gives nothing."""
    found = indexed(np.frombuffer(records, np.uint8), [(0, index)])
    if found is None:
        return None
    expected, (fits,) = walked([records])
    return fits and all(map(np.array_equal, found, expected))


def test_index_gives_what_a_walk_finds(chunk):
    records, index = chunk
    assert as_walked(records, index)
    assert len(walked([records])[0].start) == 41


def test_chunk_behind_chunk(chunk):
    records, index = chunk
    found = indexed(np.frombuffer(2 * records, np.uint8), [(0, index), (len(records), index)])
    assert all(map(np.array_equal, found, walked([records, records])[0]))
    assert indexed(np.frombuffer(records, np.uint8), [(0, index), (5, b'')]) is None


def test_wrong_bytes_give_nothing_else(chunk):
    """Neither in the index nor in the records; lengths and places are what hurts most."""
    random_, refused = random.Random(1), 0
    for _ in range(400):
        records, index = map(bytearray, chunk)
        spoilt = random_.choice((records, index))
        for _ in range(random_.choice((1, 1, 8))):
            spoilt[random_.randrange(len(spoilt))] = random_.choice((0, 1, 5, 7, 127, 255))
        agrees = as_walked(bytes(records), bytes(index))
        assert agrees in (True, None)
        refused += agrees is None
    assert 100 < refused < 400


def test_index_of_part_of_the_messages_is_refused(chunk):
    records, index = chunk
    for end in range(0, len(index), 7):
        assert as_walked(records, index[:end]) is None


def test_whole_bag_needs_nothing_compiled(tmp_path):
    write_sample(tmp_path / 'a.mcap', 5000)
    code = ('import sys; from dynsim_ros.bag import load; '
            'assert len(load(sys.argv[1])["pose"]) == 5000; sys.exit("numba" in sys.modules)')
    subprocess.run([sys.executable, '-c', code, tmp_path / 'a.mcap'], check=True, timeout=60)
