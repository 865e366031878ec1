# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
An angle less whole quarter turns, with more digits than a number has.

For angles of everyday size by subtracting multiples of three parts of pi / 2, the first two of
which are so short that their products are exact (Cody and Waite). Larger ones, and the few that
come so near to a multiple that too little would be left, take the digits of 2 / pi that matter
for them, as integers (Payne and Hanek): these remainders are exact for any number.

Source: Muller, Elementary Functions (2016), sections 11.2 to 11.5.
"""

import math

import numpy as np

from ..bits import BIAS, bits_of, MANTISSA_BITS, number_of
from ..jit import formula, kernel
from ..two_sum import two_product, two_sum

_EIGHTH = 0.25 * math.pi
# pi / 2 as the sum of a number of 27 bits, another one and the rest; 2 / pi.
_FIRST, _SECOND, _THIRD = 1.570796325802803, 9.920935739593517e-10, 5.721188726109832e-18
_INVERSE = 0.6366197723675814
# Adding it and taking it away again rounds to an integer.
_ROUND = 1.5 * 2.0 ** 52
# The largest angle for the three parts, and how much they must leave [rad].
_MODERATE, _ENOUGH = 2.0 ** 26, 2.0 ** -16
# pi / 2 as the sum of two numbers.
_HIGH, _LOW = 1.5707963267948966, 6.123233995736766e-17

# Digits to base 2^28 of 2 / pi, two zeros before the point.
_BITS = 28
_DIGITS = np.array([0, 0] + [int(digits, 16) for digits in (
    'a2f9836 e4e4415 29fc275 7d1f534 ddc0db6 295993c 439041f e5163ab debbc56 1b7246e 3a424dd '
    '2e00649 2eea09d 1921cfe 1deb1cb 129a73e e88235f 52ebb44 84e99c7 026b45f 7e41399 1d63983 '
    '5339f49 c845f8b bdf9283 b1ff897 ffde059 80fef2f 118b5a0 a6d1f6d 367ecf2 7cb09b7 4f463f6 '
    '69e5fea 2d7527b ac7ebe5 f17b3d0 739f78a 5292ea6 bfb5fb1 1f8d5d0 8560330 46fc7b6').split()])
_MASK = (1 << _BITS) - 1


@formula
def quarters_of(size):
    """
    Return how many quarter turns an angle is: that count mod 4, and the rest as two numbers.

    size: >= pi / 4 and finite [rad]; the rest is from -1/2 to 1/2.
    """
    bits = bits_of(size)
    mantissa = (bits & ((1 << MANTISSA_BITS) - 1)) | (1 << MANTISSA_BITS)
    exponent = (bits >> MANTISSA_BITS) - BIAS - MANTISSA_BITS
    # Digits before this one make multiples of four quarters.
    first = (exponent - 2) // _BITS + 1
    # The digits of the product with 2 / pi, from the last one on: units is where first is.
    high, low = mantissa >> _BITS, mantissa & _MASK
    units, a, b, c, d, e, carry = 0, 0, 0, 0, 0, 0, 0
    for place in range(first + 8, first, -1):
        total = high * _DIGITS[place + 1] + low * _DIGITS[place] + carry
        units, a, b, c, d, e = total & _MASK, units, a, b, c, d
        carry = total >> _BITS
    # The quarters are the first bits of the two digits units, a: to the nearest.
    shift = _BITS * (first + 1) - exponent
    a |= units << _BITS
    count = (a + (1 << (shift - 1))) >> shift
    a -= count << shift
    unit = 2.0 ** -_BITS
    rest, left_b = two_sum(float(a), unit * b)
    rest, left_c = two_sum(rest, unit * unit * c)
    rest, left_d = two_sum(rest, unit * unit * unit * d)
    rest, left_e = two_sum(rest, unit * unit * unit * unit * e)
    scale = number_of((BIAS - shift) << MANTISSA_BITS)
    return count & 3, scale * rest, scale * (left_b + (left_c + (left_d + left_e)))


@kernel
def less_any_quarters(x):
    """Return what less_quarters does, for |x| >= pi / 4 of any size."""
    if not abs(x) < math.inf:
        return x - x, 0.0, 0
    count, rest, rest_left = quarters_of(abs(x))
    angle, left = two_product(rest, _HIGH)
    left += rest * _LOW + rest_left * _HIGH
    if x < 0.0:
        return -angle, -left, -count & 3
    return angle, left, count


@formula
def less_quarters(x):
    """
    Return an angle x [rad] less a whole number of quarter turns, and that number mod 4.

    The angle is the sum of two numbers, the first of which is from -pi / 4 to pi / 4.
    """
    if abs(x) <= _EIGHTH:
        return x, 0.0, 0
    if abs(x) < _MODERATE:
        count = (x * _INVERSE + _ROUND) - _ROUND
        rest, left = two_sum(x - count * _FIRST, -count * _SECOND)
        left -= count * _THIRD
        angle = rest + left
        if abs(angle) > _ENOUGH:
            return angle, (rest - angle) + left, int(count) & 3
    return less_any_quarters(x)
