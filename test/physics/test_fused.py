# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""a b + c rounded once: against exact fractions, compiled and plain."""

from fractions import Fraction
import math

from dynsim_ros.physics.fused import fused, fused_by_fractions
from dynsim_ros.physics.jit import kernel
from dynsim_ros.physics.lanes import lanes_at, put_lanes
import numpy as np
import pytest


@kernel
def fuse_numbers(a, b, c):
    """Return fused(a, b, c)."""
    return fused(a, b, c)


@kernel
def fuse_lanes(a, b, c, out):
    """Write fused(a, b, c) of four numbers each to out."""
    put_lanes(out, 0, fused(lanes_at(a, 0), lanes_at(b, 0), lanes_at(c, 0)))


def numbers():
    """Return rows of a, b, c; in half of them the product nearly cancels."""
    random = np.random.default_rng(7)
    a, b, c = random.normal(size=(3, 400)) * 10.0 ** random.integers(-12, 12, (3, 400))
    c[::2] = -(a * b)[::2]
    return np.array([a, b, c]).T


def test_is_rounded_once():
    for a, b, c in numbers():
        exact = float(Fraction(a) * Fraction(b) + Fraction(c))
        assert fused(a, b, c) == fuse_numbers(a, b, c) == exact
        assert fused_by_fractions(a, b, c) == exact
    assert any(fused(a, b, c) != a * b + c for a, b, c in numbers())


def test_lanes_are_numbers_side_by_side():
    for rows in numbers().reshape(-1, 4, 3):
        a, b, c = (np.ascontiguousarray(column) for column in rows.T)
        out = np.zeros(4)
        fuse_lanes(a, b, c, out)
        np.testing.assert_array_equal(out, [fused(*row) for row in rows])
        np.testing.assert_array_equal(fused(a, b, c), out)
        np.testing.assert_array_equal(fused(2.0, b, c), [fused(2.0, *row[1:]) for row in rows])


@pytest.mark.parametrize('a, b, c', [
    (1e200, 1e200, 0.0), (-1e200, 1e200, 1e300), (1e200, 1e200, -math.inf), (math.inf, 0.0, 1.0),
    (math.nan, 1.0, 1.0), (0.0, -1.0, 0.0), (0.0, -1.0, -0.0), (1e-200, 1e-200, 0.0),
    (5e-324, 0.5, 5e-324), (1e200, 1e200, -1e308)])
def test_wild_numbers(a, b, c):
    compiled = fuse_numbers(a, b, c)
    for plain in (fused(a, b, c), fused_by_fractions(a, b, c)):
        assert np.array_equal(compiled, plain, equal_nan=True)
        assert math.copysign(1.0, compiled) == math.copysign(1.0, plain) or math.isnan(plain)
