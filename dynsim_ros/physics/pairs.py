# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Numbers of twice the digits: pairs of floats whose sum they are, the second small.

Each result is exact to some units of 2^-104 of it. Source: T. J. Dekker, A floating-point
technique for extending the available precision, Numer. Math. 18 (1971), 224-242; Y. Hida, X. S. Li
and D. H. Bailey, Algorithms for quad-double precision floating point arithmetic, Proc. 15th IEEE
Symposium on Computer Arithmetic (2001).
"""

import math

from .jit import formula
from .two_sum import two_product, two_sum


@formula
def pair(a):
    """Return a float as a pair."""
    return a, 0.0


@formula
def negative(a):
    """Return -a."""
    return -a[0], -a[1]


@formula
def pair_sum(a, b):
    """Return a + b."""
    first, first_left = two_sum(a[0], b[0])
    second, second_left = two_sum(a[1], b[1])
    first, left = two_sum(first, first_left + second)
    return two_sum(first, left + second_left)


@formula
def pair_difference(a, b):
    """Return a - b."""
    return pair_sum(a, negative(b))


@formula
def pair_product(a, b):
    """Return a b."""
    product, left = two_product(a[0], b[0])
    return two_sum(product, left + (a[0] * b[1] + a[1] * b[0]))


@formula
def pair_multiple(s, a):
    """Return s a; s: a float."""
    product, left = two_product(s, a[0])
    return two_sum(product, left + s * a[1])


@formula
def pair_quotient(a, b):
    """Return a / b: three digits of a long division whose digits are floats."""
    first = a[0] / b[0]
    rest = pair_difference(a, pair_multiple(first, b))
    second = rest[0] / b[0]
    rest = pair_difference(rest, pair_multiple(second, b))
    first, left = two_sum(first, second)
    return two_sum(first, left + rest[0] / b[0])


@formula
def pair_root(a):
    """Return the square root of a >= 0: one step of Newton's method from that of a float."""
    root = math.sqrt(a[0])
    if root == 0.0:
        return 0.0, 0.0
    rest = pair_difference(a, two_product(root, root))
    return two_sum(root, rest[0] / (2.0 * root))
