# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Rows left out for drawing: never a peak."""

from dynsim_ros.view.thin import thinned
import numpy as np
import pytest


@pytest.mark.parametrize('count, columns', [(60_001, (0, 1, 2)), (5003, (2,)), (1801, (0, 1))])
def test_every_peak_is_kept(count, columns):
    random = np.random.default_rng(count)
    values = np.cumsum(random.normal(size=(count + 40, 3)), axis=0)
    first, last = 17, 17 + count
    # single rows that stand out, as a blow of one tick does
    spikes = random.integers(first, last, 25)
    values[spikes] += random.choice([-1e3, 1e3], (25, 1)) * random.random((25, 1))
    rows = thinned(values, first, last, columns)
    assert rows[0] == first and rows[-1] == last - 1
    assert (np.diff(rows) > 0).all()
    assert len(rows) <= 2 * len(columns) * 300 + 2
    edges = first + np.arange(301) * count // 300
    for column in columns:
        for start, end in zip(edges, edges[1:]):
            every = values[start:end, column]
            kept = values[rows[(rows >= start) & (rows < end)], column]
            # a peak may also be drawn in the first row of the next stretch
            near = values[rows[(rows >= start) & (rows <= end)], column]
            assert near.max() >= every.max() and near.min() <= every.min(), (kept, every)


def test_few_rows_are_left_as_they_are():
    values = np.zeros((1800, 3))
    assert np.array_equal(thinned(values, 3, 1790, (0, 1, 2)), np.arange(3, 1790))


def test_bad_luck_with_equal_numbers():
    rows = thinned(np.zeros((10_000, 1)), 0, 10_000, (0,))
    assert rows[0] == 0 and rows[-1] == 9999
