# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Vectors of three numbers of any kind, as lists.

Numbers may be floats of any precision, symbols of heyoka, or those of symbols.py, which become
source code. What is zero by the scene is the float 0.0, and is left out of sums and products.
"""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Numbers:
    """What the equations need of a kind of number: of a float, and x ** -0.5."""

    of: Callable
    inverse_sqrt: Callable


def is_zero(a):
    return isinstance(a, float) and a == 0.0


def times(a, b):
    return 0.0 if is_zero(a) or is_zero(b) else a * b


def plus(a, b):
    if is_zero(a):
        return b
    return a if is_zero(b) else a + b


def minus(a, b):
    if is_zero(b):
        return a
    return -b if is_zero(a) else a - b


def add(a, b):
    return [plus(p, q) for p, q in zip(a, b)]


def subtract(a, b):
    return [minus(p, q) for p, q in zip(a, b)]


def scale(s, a):
    return [times(s, p) for p in a]


def dot(a, b):
    total = 0.0
    for p, q in zip(a, b):
        total = plus(total, times(p, q))
    return total


def cross(a, b):
    return [minus(times(a[i], b[j]), times(a[j], b[i])) for i, j in ((1, 2), (2, 0), (0, 1))]


def columns(q, number):
    """Return b_x, b_y, b_z in world of a unit quaternion."""
    w, x, y, z = q
    one, two = number(1.0), number(2.0)
    return ([one - two * (y * y + z * z), two * (x * y + w * z), two * (x * z - w * y)],
            [two * (x * y - w * z), one - two * (x * x + z * z), two * (y * z + w * x)],
            [two * (x * z + w * y), two * (y * z - w * x), one - two * (x * x + y * y)])


def numbers_of(numbers, value):
    """Return a number of the kind, but 0.0 for nothing."""
    return 0.0 if value == 0 else numbers.of(float(value))
