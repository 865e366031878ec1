# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Rotation of a vector with twice the digits, for what rounding would decide otherwise."""

from ...physics.jit import formula
from ...physics.two_sum import two_product, two_sum


@formula
def difference_of_products(a, b, c, d):
    """Return a b - c d as the sum of two numbers; b and d: such sums, a and c: numbers."""
    first, first_left = two_product(a, b[0])
    second, second_left = two_product(c, d[0])
    total, left = two_sum(first, -second)
    return total, left + (first_left - second_left + (a * b[1] - c * d[1]))


@formula
def cross_twice_as_long(a, b):
    """Return a x b; a: (3,), b and the result: three pairs of numbers to be added."""
    return (difference_of_products(a[1], b[2], a[2], b[1]),
            difference_of_products(a[2], b[0], a[0], b[2]),
            difference_of_products(a[0], b[1], a[1], b[0]))


@formula
def squared_norm(q):
    """Return w^2 + x^2 + y^2 + z^2 as the sum of two numbers."""
    total, left = 0.0, 0.0
    for component in q:
        square, rest = two_product(component, component)
        total, more = two_sum(total, square)
        left += rest + more
    return total, left


@formula
def corrected(a, w, c, d, size):
    """Return a + 2 (d - w c) / size as the sum of two numbers; c, d, size: such sums."""
    product, left = two_product(w, c[0])
    total, more = two_sum(d[0], -product)
    more += d[1] - (left + w * c[1])
    quotient = 2.0 * total / size[0]
    back, rest = two_product(quotient, size[0])
    rest = ((2.0 * total - back) - rest + 2.0 * more - quotient * size[1]) / size[0]
    result, left = two_sum(a, quotient)
    return two_sum(result, left + rest)


@formula
def rotate_back_exactly(q, a):
    """
    Return the components in body axes of a vector a in world, as two (3,) to be added.

    q: quaternion (w, x, y, z), of any norm: it counts as divided by that.
    """
    u = (q[1], q[2], q[3])
    c = cross_twice_as_long(u, ((a[0], 0.0), (a[1], 0.0), (a[2], 0.0)))
    d = cross_twice_as_long(u, c)
    size = squared_norm(q)
    x, x_left = corrected(a[0], q[0], c[0], d[0], size)
    y, y_left = corrected(a[1], q[0], c[1], d[1], size)
    z, z_left = corrected(a[2], q[0], c[2], d[2], size)
    return (x, y, z), (x_left, y_left, z_left)
