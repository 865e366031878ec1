# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The exponential, and the same less 1, which keeps its digits where that is nearly zero.

exp(x) = 2^n exp(r) with |r| <= log(2) / 2, and exp(r) by a polynomial.
"""

import math

from ..bits import BIAS, MANTISSA_BITS, number_of
from ..jit import formula

# 1 / log(2), and log(2) as the sum of two numbers, the first of 42 bits: n times it is exact.
_INVERSE, _HIGH, _LOW = 1.4426950408889634, 0.6931471805598903, 5.497923018708371e-14
# Adding it and taking it away again rounds to an integer.
_ROUND = 1.5 * 2.0 ** 52
# Beyond these the exponential is infinite, and zero.
_HIGHEST, _LOWEST = 709.79, -745.14


@formula
def series(r, square):
    """Return (exp(r) - 1 - r - r^2 / 2) / r^3; square: r^2."""
    fourth = square * square
    return (((0.16666666666666669 + r * 0.041666666666666664)
             + square * (0.008333333333330062 + r * 0.0013888888888886552))
            + fourth * ((0.00019841269863053618 + r * 2.4801587317144498e-05)
                        + square * (2.7557268459997064e-06 + r * 2.755728296954995e-07))
            + fourth * fourth * (2.510038549551032e-08 + r * 2.0911236630261545e-09))


@formula
def power_of_two(n):
    """Return 2^n; n: integer from -1022 to 1023."""
    return number_of((n + BIAS) << MANTISSA_BITS)


@formula
def exponential(x):
    """Return exp(x) and exp(x) - 1; one that is not used is not computed either."""
    if not _LOWEST < x < _HIGHEST:
        if x > 0.0:
            return math.inf, math.inf
        return (0.0, -1.0) if x < 0.0 else (x, x)
    count = (x * _INVERSE + _ROUND) - _ROUND
    n = int(count)
    # exp(r) = 1 + r + rest
    whole, low = x - count * _HIGH, count * _LOW
    r = whole - low
    left = (whole - r) - low
    square = r * r
    rest = (0.5 * square + r * square * series(r, square)) + (left + left * r)
    one = 1.0 + (r + rest)
    if abs(n) > 60:
        # In two steps: either power alone may be out of range.
        power = one * power_of_two(n >> 1) * power_of_two(n - (n >> 1))
        return power, power - 1.0
    scale = power_of_two(n)
    # 2^n - 1 + 2^n r + 2^n rest
    less, part = scale - 1.0, scale * r
    head = less + part
    less = head + (((less - head + part) + ((scale - less) - 1.0)) + scale * rest)
    # For -0 it is -0.
    return scale * one, math.copysign(less, x)
