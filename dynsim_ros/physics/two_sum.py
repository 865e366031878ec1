# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Sums, products and quotients with the rounding error that they make, as a second number.

Source: Knuth, The Art of Computer Programming 2 (1997), 4.2.2; T. J. Dekker, A floating-point
technique for extending the available precision, Numer. Math. 18 (1971), 224-242.
"""

from .jit import formula

_SPLITTER = 2.0 ** 27 + 1.0


@formula
def two_sum(a, b):
    """Return a + b as rounded, and what rounding has left out."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


@formula
def halves(a):
    """Return two numbers of 26 bits whose sum is a; |a| < 1e300."""
    part = _SPLITTER * a
    high = part - (part - a)
    return high, a - high


@formula
def two_product(a, b):
    """Return a b as rounded, and what rounding has left out."""
    product = a * b
    a_high, a_low = halves(a)
    b_high, b_low = halves(b)
    return product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low


@formula
def quotient_in_two(a, b, a_left=0.0, b_left=0.0):
    """Return (a + a_left) / (b + b_left) as the sum of two numbers; what is left is small."""
    quotient = a / b
    back, left = two_product(quotient, b)
    return quotient, ((a - back) - left + (a_left - quotient * b_left)) / b
