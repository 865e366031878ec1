# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers of twice the digits, against mpmath."""

from dynsim_ros.physics import pairs
import mpmath as mp
import numpy as np
from plain import compiled
import pytest

# 2^-104 is 5e-32: a few units
CLOSE = 2e-31
EXACT = {'pair_sum': lambda x, y: x + y, 'pair_difference': lambda x, y: x - y,
         'pair_product': lambda x, y: x * y, 'pair_quotient': lambda x, y: x / y}


def exact(a):
    return mp.mpf(a[0]) + mp.mpf(a[1])


def some(count, seed):
    """Return pairs of many sizes, some of them with nothing in their second half."""
    random = np.random.default_rng(seed)
    first = random.normal(size=count) * 10.0 ** random.integers(-12, 12, count)
    second = random.choice([0.0, 0.5], count) * random.uniform(-1, 1, count) * np.spacing(first)
    return list(zip(first.tolist(), second.tolist()))


def check(found, expected):
    """Assert that a pair is what is expected, to its last digits, and of two halves."""
    assert found[0] + found[1] == found[0]
    assert abs(exact(found) - expected) <= CLOSE * abs(expected)


@pytest.mark.parametrize('name', EXACT)
def test_of_two_pairs(name):
    formula = getattr(pairs, name)
    in_machine_code = compiled(formula)
    with mp.workdps(60):
        for a, b in zip(some(300, 1), some(300, 2)):
            found = formula(a, b)
            check(found, EXACT[name](exact(a), exact(b)))
            assert in_machine_code(a, b) == found


def test_differences_of_neighbours():
    with mp.workdps(60):
        for a, b in zip(some(100, 3), some(100, 4)):
            near = pairs.pair_sum(a, (1e-20 * b[0], 0.0))
            check(pairs.pair_difference(near, a), exact(near) - exact(a))


def test_roots_and_multiples():
    root = compiled(pairs.pair_root)
    with mp.workdps(60):
        for a in some(300, 5):
            check(pairs.pair_multiple(3.7, a), mp.mpf(3.7) * exact(a))
            a = a if a[0] > 0.0 else pairs.negative(a)
            check(pairs.pair_root(a), mp.sqrt(exact(a)))
            assert root(a) == pairs.pair_root(a)
    assert pairs.pair_root(pairs.pair(0.0)) == (0.0, 0.0)
