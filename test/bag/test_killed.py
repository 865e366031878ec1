# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A recording process that is killed: what is lost is little, and what is left comes back."""

from dynsim_ros.bag.reader import open_bag
from dynsim_ros.bag.recovery.recover import recover
from other_readers import by_mcap
import pytest
from tree import ROOT


@pytest.mark.parametrize('compression', ['zstd', 'lz4', 'none'])
def test_of_a_process_that_is_killed_the_end_is_lost_and_no_more(
        tmp_path, monkeypatch, compression):
    monkeypatch.syspath_prepend(str(ROOT / 'benchmarks'))
    import bag_killed
    path = tmp_path / 'run.mcap'
    end_ns = bag_killed.killed(path, compression, 300_000_000)
    with open_bag(path) as bag:
        assert bag.problem.startswith('the file was not finished: ')
        before = list(bag.messages())
    found = recover(path)
    assert (found.holes, found.messages, found.kept) == ([], len(before), None)
    # loose: a machine that is busy lets the writing thread wait; 0.05 s is what it is made for
    assert found.last_ns >= end_ns - 250_000_000
    assert by_mcap(path) == (before, len(before))
    poses = [stamp for topic, stamp, _ in before if topic == '/dynsim/sphere/pose']
    assert poses == list(range(0, found.last_ns + 1, 1_000_000))
