# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Arc tangent and area tangent (the inverse of tanh): one power series but for signs.

Sums and quotients carry what rounding leaves out of them: all that is rounded is the result.
"""

import math

from ..bits import BIAS, bits_of, MANTISSA_BITS, number_of
from ..jit import formula
from ..two_sum import quotient_in_two, two_product, two_sum

# pi / 4 and log(2) / 2, each the sum of two numbers; the first of the latter has 42 bits.
_EIGHTH, _EIGHTH_LEFT = 0.7853981633974483, 3.061616997868383e-17
_HALF_OCTAVE, _HALF_OCTAVE_LEFT = 0.34657359027994517, 2.7489615093541856e-14
# tan(pi / 8), and the half of a half octave: artanh of it is log(2) / 4.
_STEEP, _FAR = 0.4142135623730951, 0.1715728752538099
# The arc tangent of a smaller slope is the slope.
_FLAT = 2.0 ** -30
_SQRT_2 = 1.4142135623730951


@formula
def series(z):
    """Return (arctan(x) / x - 1) / z; z: x^2, or -x^2 for artanh(x)."""
    return -0.3333333333333333 + z * (0.20000000000000004 + z * (-0.14285714285713855 + z * (
        0.11111111111075858 + z * (-0.09090909091453085 + z * (0.07692307759368341 + z * (
            -0.06666667551385975 + z * (0.05882326774368544 + z * (-0.0526212983040719 + z * (
                0.04746315949969007 + z * (-0.04215152320784454 + z * (
                    0.0332219446846096 - z * 0.016538635263317336)))))))))))


@formula
def slope(small, large):
    """
    Return small / large, from 0 to 1, as the sum of two numbers, and 0.

    Or, if that is steep, what remains of the slope after a turn back by pi / 4, and 1.
    """
    if large == 0.0:
        return 0.0, 0.0, 0.0
    if small <= _FLAT * large:
        return small / large, 0.0, 0.0
    # Far enough from both ends of what numbers can be.
    if large > 2.0 ** 500:
        small, large = 2.0 ** -600 * small, 2.0 ** -600 * large
    elif large < 2.0 ** -400:
        small, large = 2.0 ** 600 * small, 2.0 ** 600 * large
    if small <= _STEEP * large:
        r, left = quotient_in_two(small, large)
        return r, left, 0.0
    n, n_left = two_sum(small, -large)
    d, d_left = two_sum(small, large)
    r, left = quotient_in_two(n, d, n_left, d_left)
    return r, left, 1.0


@formula
def arc_tangent(y, x):
    """Return the angle of the point (x, y) from -pi to pi [rad], as atan2 does."""
    across, along = abs(y), abs(x)
    if not across + along < math.inf:
        if across != across or along != along:
            return x + y
        if across == math.inf or along == math.inf:
            across = 1.0 if across == math.inf else 0.0
            along = 1.0 if along == math.inf else 0.0
    small, large = min(across, along), max(across, along)
    # The angle of small and large: so many eighths of a whole turn, and the arc tangent of r.
    r, r_left, eighths = slope(small, large)
    sign = 1.0
    if across > along:
        eighths, sign = 2.0 - eighths, -sign
    if math.copysign(1.0, x) < 0.0:
        eighths, sign = 4.0 - eighths, -sign
    z = r * r
    rest = r * z * series(z) + (r_left - z * r_left)
    turned, turned_left = two_product(eighths, _EIGHTH)
    head, left = two_sum(turned, sign * r)
    left += turned_left + eighths * _EIGHTH_LEFT + sign * rest
    return math.copysign(head + left, y)


@formula
def area_tangent(x):
    """Return artanh(x); infinite for x = -1 and 1, not a number beyond."""
    size = abs(x)
    if not size < 1.0:
        return math.copysign(math.inf, x) if size == 1.0 else math.nan
    if size <= _FAR:
        z = x * x
        return x - x * z * series(-z)
    # (1 + x) / (1 - x) is 2^n n / d, with n / d about 1: half of its logarithm is asked for.
    n, n_left = two_sum(1.0, size)
    d, d_left = two_sum(1.0, -size)
    octaves = (bits_of(_SQRT_2 * n / d) >> MANTISSA_BITS) - BIAS
    scale = number_of((octaves + BIAS) << MANTISSA_BITS)
    d, d_left = scale * d, scale * d_left
    less, less_left = two_sum(n, -d)
    more, more_left = two_sum(n, d)
    r, r_left = quotient_in_two(less, more, less_left + (n_left - d_left),
                                more_left + (n_left + d_left))
    z = r * r
    head, left = two_sum(octaves * _HALF_OCTAVE, r)
    left += octaves * _HALF_OCTAVE_LEFT + (r_left - r * z * series(-z))
    return math.copysign(head + left, x)
