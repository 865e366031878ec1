# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Phases with twice the digits: an angle of many turns is then known as well as its rate and time.

The rounding of an angle of 1e5 rad is 1e-11 rad. What rounding leaves out of rates, times and
their product is therefore carried along as a second number.
"""

import math

from .rotate_exactly import squared_norm
from ...physics.elementary import sine_cosine
from ...physics.jit import formula
from ...physics.two_sum import two_product

_SECOND = 1_000_000_000


@formula
def seconds(time_ns):
    """Return a time as the sum of two numbers [s]; time_ns: integer below 2^53 [ns]."""
    ns = float(time_ns)
    t = ns / _SECOND
    whole, left = two_product(t, float(_SECOND))
    return t, ((ns - whole) - left) / _SECOND


@formula
def root_in_two(square, square_left):
    """Return the square root of the sum of two numbers as such a sum."""
    root = math.sqrt(square)
    if root == 0.0:
        return 0.0, 0.0
    back, left = two_product(root, root)
    return root, ((square - back) - left + square_left) / (2.0 * root)


@formula
def norm_in_two(a):
    """Return the length of a vector as the sum of two numbers."""
    square, left = squared_norm(a)
    return root_in_two(square, left)


@formula
def angle_in_two(rate, rate_left, t, t_left):
    """Return rate times time, each the sum of two numbers, as such a sum."""
    angle, left = two_product(rate, t)
    return angle, left + (rate * t_left + rate_left * t)


@formula
def cosine_and_sine(angle, left):
    """Return cosine and sine of the sum of two numbers; |left| < 1e-5."""
    s, c = sine_cosine(angle)
    return c - left * (s + 0.5 * left * c), s + left * (c - 0.5 * left * s)
