# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Every operation on Lanes and Cells, compiled: bit for bit as numpy does it on four numbers."""

from dynsim_ros.physics.cells import lane_cells, number_cells
from dynsim_ros.physics.jit import kernel
from dynsim_ros.physics.lanes import choose, lane, lanes_at, root, spread, total, totals
import numpy as np
import pytest

ROWS = ('a + b', 'a - b', 'a * b', 'a / b', 'a + s', 's - a', 'a * s', 's / a', '-a', 'root(a)',
        'choose(mask, a, b)', 'choose(mask, s, b)', 'spread(s)', 'a if s > 0 else s',
        'lane cells', 'views')
NUMBERS = np.random.default_rng(5).normal(size=(3, 16)) * 10.0 ** np.arange(-8, 8)
# odd ones too: zeros of both signs, the largest and the smallest, infinities, not a number
ODD = [0.0, -0.0, 1e308, -1e308, 5e-324, -5e-324, 2.2e-308, np.inf, -np.inf, np.nan, 1.0, -1.0]


@kernel
def keep(array, row, a):
    """Write four numbers to a row."""
    for i in range(4):
        array[row, i] = lane(a, i)


@kernel
def chosen_type(a, s):
    """Return Lanes on one way through the code, a number on another."""
    if s > 0.0:
        return a
    return s


@kernel
def operate(x, y, mask_row, s, memory, rows, sums):
    """Write what each of ROWS gives for x[i:i + 4] and y[i:i + 4]."""
    for i in range(0, x.shape[0], 4):
        a, b, mask = lanes_at(x, i), lanes_at(y, i), lanes_at(mask_row, i)
        out = rows[:, i:i + 4]
        keep(out, 0, a + b)
        keep(out, 1, a - b)
        keep(out, 2, a * b)
        keep(out, 3, a / b)
        keep(out, 4, a + s)
        keep(out, 5, s - a)
        keep(out, 6, a * s)
        keep(out, 7, s / a)
        keep(out, 8, -a)
        keep(out, 9, root(a))
        keep(out, 10, choose(mask, a, b))
        keep(out, 11, choose(mask, s, b))
        keep(out, 12, spread(s))
        keep(out, 13, chosen_type(a, s))
        cells, views = lane_cells(None, memory, 0, 3), lane_cells(2, memory, 4, 3)
        cells[2] = a
        views[1] = cells[2] + b
        keep(out, 14, cells[2])
        keep(out, 15, views[1])
        numbers, number_views = number_cells(None, memory, 0, 2), number_cells(2, memory, 8, 4)
        numbers[1] = total(a)
        sums[i // 4, 0] = numbers[1]
        sums[i // 4, 1] = root(s)
        sums[i // 4, 2] = number_views[2]
        four = totals(a, b, a - b, a * b)
        for k in range(4):
            sums[i // 4, 3 + k] = lane(four, k)


def expected(x, y, mask, s):
    """Return the same by numpy alone, and the sums."""
    rows = [x + y, x - y, x * y, x / y, x + s, s - x, x * s, s / x, -x, np.sqrt(x),
            np.where(mask != 0, x, y), np.where(mask != 0, s, y), np.full_like(x, s),
            x if s > 0 else np.full_like(x, s), x, x + y]
    # views[1] begins at memory[8], as number_views do
    sums = [in_pairs(x), np.full(len(x) // 4, np.sqrt(s)), (x + y)[2::4], in_pairs(x), in_pairs(y),
            in_pairs(x - y), in_pairs(x * y)]
    return np.array(rows), np.array(sums).T


def in_pairs(x):
    """Return the sums of each four numbers."""
    fours = x.reshape(-1, 4)
    return (fours[:, 0] + fours[:, 1]) + (fours[:, 2] + fours[:, 3])


def bits(array):
    """Return the bits of numbers; those of a not-a-number are not said by any standard."""
    return np.where(np.isnan(array), np.nan, array).view(np.int64)


@pytest.mark.parametrize('s', [0.3, -2.5e-200, np.inf])
def test_operations(s):
    x, y = (np.concatenate([numbers, odd]) for numbers, odd in zip(
        NUMBERS, (np.repeat(ODD, len(ODD)), np.tile(ODD, len(ODD)))))
    mask = np.tile([0.0, 1.0, -0.0, np.nan, 5e-324], len(x))[:len(x)]
    rows, sums = np.full((len(ROWS), len(x)), 7.0), np.full((len(x) // 4, 7), 7.0)
    operate(x, y, mask, s, np.zeros(64), rows, sums)
    with np.errstate(all='ignore'):
        by_numpy = expected(x, y, mask, s)
    for name, ours, theirs in zip(ROWS, rows, by_numpy[0]):
        np.testing.assert_array_equal(bits(ours), bits(theirs), name)
    np.testing.assert_array_equal(bits(sums), bits(by_numpy[1]))


def test_plain_python_does_the_same():
    x, y, s = *NUMBERS[:2], 0.7
    mask = np.tile([0.0, 1.0], 8)
    rows, sums = np.zeros((len(ROWS), 16)), np.zeros((4, 7))
    for i in range(0, 16, 4):
        a, b, m = lanes_at(x, i), lanes_at(y, i), lanes_at(mask, i)
        found = [a + b, a - b, a * b, a / b, a + s, s - a, a * s, s / a, -a, root(np.abs(a)),
                 choose(m, a, b), choose(m, s, b), spread(s), a, a, a + b]
        rows[:, i:i + 4] = found
        sums[i // 4] = total(a), root(s), lane(a + b, 2), *totals(a, b, a - b, a * b)
    with np.errstate(invalid='ignore'):
        by_numpy = expected(x, y, mask, s)
    by_numpy[0][9] = np.sqrt(np.abs(x))
    np.testing.assert_array_equal(rows, by_numpy[0])
    np.testing.assert_array_equal(sums, by_numpy[1])


def test_what_lanes_at_gives_is_not_the_memory_itself():
    memory = np.arange(8.0)
    lanes = lanes_at(memory, 2)
    memory[:] = 0.0
    np.testing.assert_array_equal(lanes, [2.0, 3.0, 4.0, 5.0])
