# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Messages found by the index of their chunk, which may be wrong, beside a walk over all records."""

import random
import subprocess
import sys

from bag_samples import sample_messages, write_foreign, write_sample
from dynsim_ros.bag.load_messages import find_messages
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


def same(one, other):
    (found, fits), (walked, walk_fits) = one, other
    return fits == walk_fits and all(map(np.array_equal, found, walked))


def test_index_and_walk_agree(chunk):
    records, index = chunk
    found, fits = find_messages(records, index)
    assert fits and len(found.start) == 41
    assert same((found, fits), find_messages(records, b''))


def test_no_wrong_byte_changes_what_a_walk_finds(chunk):
    """Neither in the index nor in the records; lengths and places are what hurts most."""
    random_ = random.Random(1)
    for _ in range(400):
        records, index = map(bytearray, chunk)
        spoilt = random_.choice((records, index))
        for _ in range(random_.choice((1, 1, 8))):
            spoilt[random_.randrange(len(spoilt))] = random_.choice((0, 1, 5, 7, 127, 255))
        assert same(find_messages(bytes(records), bytes(index)),
                    find_messages(bytes(records), b''))


def test_index_of_part_of_the_messages(chunk):
    records, index = chunk
    for end in range(0, len(index), 7):
        assert same(find_messages(records, index[:end]), find_messages(records, b''))


def test_whole_bag_needs_nothing_compiled(tmp_path):
    write_sample(tmp_path / 'a.mcap', 5000)
    code = ('import sys; from dynsim_ros.bag import load; '
            'assert len(load(sys.argv[1])["pose"]) == 5000; sys.exit("numba" in sys.modules)')
    subprocess.run([sys.executable, '-c', code, tmp_path / 'a.mcap'], check=True, timeout=60)
