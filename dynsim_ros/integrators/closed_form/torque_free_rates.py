# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Period and precession of a free rotation with twice the digits.

After thousands of turns the rounding of a rate is what is wrong with the orientation. Both rates
are complete elliptic integrals of the first and the third kind, which arithmetic-geometric means
give to any number of digits (DLMF 19.8.5 and 19.8.7; Landau and Lifshitz, Mechanics (1976),
section 37, for the angle of precession in a period). Numbers are pairs, see physics.pairs.
"""

import math

from .phase import norm_in_two
from .rotate_exactly import rotate_back_exactly
from .torque_free import TorqueFree
from .torque_free_setup import setup_in_body
from ...physics.bits import BIAS, bits_of, MANTISSA_BITS, number_of
from ...physics.jit import formula
from ...physics.pairs import (pair, pair_difference, pair_multiple, pair_product, pair_quotient,
                              pair_root, pair_sum)

_PI = (3.141592653589793, 1.2246467991473532e-16)
# The means converge quadratically; a modulus so close to 1 that this does not do has none.
_MOST_MEANS = 60
# Of the means: what lies nearer is the same.
_NEAR = 1e-30


@formula
def complete_integrals(root, characteristic):
    """
    Return K and Pi of the modulus k and of a characteristic alpha^2 < 1, all pairs.

    root: the complementary modulus, in (0, 1].
    """
    one = pair(1.0)
    a, g = one, root
    square = pair_difference(one, characteristic)
    p, weight, total = pair_root(square), one, one
    for _ in range(_MOST_MEANS):
        product, p_square = pair_product(a, g), pair_product(p, p)
        larger = pair_sum(p_square, product)
        weight = pair_multiple(0.5, pair_product(weight, pair_quotient(
            pair_difference(p_square, product), larger)))
        total = pair_sum(total, weight)
        p = pair_multiple(0.5, pair_quotient(larger, p))
        apart = pair_difference(a, g)
        a, g = pair_multiple(0.5, pair_sum(a, g)), pair_root(product)
        if abs(apart[0]) <= _NEAR * a[0] and abs(weight[0]) <= _NEAR * abs(total[0]):
            break
    first = pair_quotient(_PI, pair_multiple(2.0, a))
    third = pair_sum(one, pair_multiple(0.5, pair_product(
        pair_quotient(characteristic, square), total)))
    return first, pair_product(first, third)


@formula
def weighted(moment, larger, smaller, w):
    """Return moment (larger - smaller) w^2; moments: floats."""
    return pair_product(pair_multiple(moment, pair_difference(pair(larger), pair(smaller))),
                        pair_product(w, w))


@formula
def half_period_and_precession(moments, w):
    """
    Return half of the period of u, K / |p|, and half of the angle of precession in it.

    moments: those of e_1, e_2, e_3, floats; w: omega along these, of any sign, pairs. Half of the
    period is 0 on the separatrix, which has none.
    """
    a, b, c = moments
    along = pair_sum(weighted(b, b, a, w[1]), weighted(c, c, a, w[2]))
    side = pair_difference(weighted(c, c, b, w[2]), weighted(a, b, a, w[0]))
    c_a, c_b, b_a = (pair_difference(pair(c), pair(a)), pair_difference(pair(c), pair(b)),
                     pair_difference(pair(b), pair(a)))
    scale = pair_product(c_b, along)
    complement = pair_quotient(pair_product(c_a, side), scale)
    if not complement[0] > 0.0:
        return (0.0, 0.0), (0.0, 0.0)
    rate = pair_root(pair_quotient(scale, pair_multiple(a, pair_multiple(b, pair(c)))))
    first, third = complete_integrals(pair_root(complement), pair_quotient(
        pair_multiple(-c, b_a), pair_multiple(a, c_b)))
    x, y, z = pair_multiple(a, w[0]), pair_multiple(b, w[1]), pair_multiple(c, w[2])
    momentum = pair_root(pair_sum(pair_product(x, x), pair_sum(pair_product(y, y),
                                                               pair_product(z, z))))
    angle = pair_sum(first, pair_product(pair_quotient(c_a, pair(a)), third))
    return (pair_quotient(first, rate),
            pair_quotient(pair_product(pair_quotient(momentum, pair(c)), angle), rate))


@formula
def along_axis(axis, in_body, left):
    """Return the component of in_body + left along an axis as a pair; each (3,)."""
    x = pair_multiple(axis[0], (in_body[0], left[0]))
    y = pair_multiple(axis[1], (in_body[1], left[1]))
    z = pair_multiple(axis[2], (in_body[2], left[2]))
    return pair_sum(x, pair_sum(y, z))


@formula
def power_of_two(size):
    """Return the power of two that brings a number from 0 to 1e300 near 1 when multiplied."""
    return number_of((2 * BIAS - (bits_of(size) >> MANTISSA_BITS)) << MANTISSA_BITS)


@formula
def of_usual_size(moments, w):
    """Return both times powers of two, so that no product is too small, and that for w."""
    weight = power_of_two(max(moments[0], moments[2]))
    factor = power_of_two(max(abs(w[0][0]), abs(w[1][0]), abs(w[2][0])))
    return ((weight * moments[0], weight * moments[1], weight * moments[2]),
            (pair_multiple(factor, w[0]), pair_multiple(factor, w[1]),
             pair_multiple(factor, w[2])), factor)


@formula
def with_rates(motion, period, advance):
    """
    Return the motion with a period [s] and with half of the angle of precession in it [rad].

    From Euler's angles, of which the latter comes, to chi it is some right angles more or less.
    """
    turn = pair(motion.circulation * motion.jacobi.turn)
    right = pair_multiple(0.5, _PI)
    rough = pair_difference(pair_multiple(motion.precession, period), turn)
    difference = pair_quotient(pair_difference(rough, advance), right)[0]
    quarters = float(math.floor(difference + 0.5))
    # So many turns in a period that rounding hides which: no run lasts that long.
    if not abs(difference - quarters) <= 0.1:
        return motion
    advance = pair_sum(advance, pair_multiple(quarters, right))
    precession = pair_quotient(pair_sum(advance, turn), period)
    return TorqueFree(motion.jacobi, motion.rate, motion.phase, period[0], period[1],
                      motion.circulation, precession[0], precession[1], motion.direction,
                      motion.omega, motion.body, motion.world)


@formula
def with_precession(motion, rate, left):
    """Return a steady motion with its rate as the sum of two numbers [rad/s]."""
    return TorqueFree(motion.jacobi, motion.rate, motion.phase, motion.period, motion.period_left,
                      motion.circulation, 0.5 * rate, 0.5 * left, motion.direction, motion.omega,
                      motion.body, motion.world)


@formula
def torque_free_in_full(moments, axes, q, omega):
    """
    Return the TorqueFree of torque_free_setup, its rates known to the last bit and beyond.

    Arguments: as for torque_free_setup.
    """
    in_body, left = rotate_back_exactly(q, omega)
    motion = setup_in_body(moments, axes, q, in_body, left)
    if motion.rate == 0.0:
        return with_precession(motion, *norm_in_two(omega))
    w = (along_axis(axes[0], in_body, left), along_axis(axes[1], in_body, left),
         along_axis(axes[2], in_body, left))
    if motion.circulation < 0.0:
        moments, w = (moments[2], moments[1], moments[0]), (w[2], w[1], w[0])
    moments, w, factor = of_usual_size(moments, w)
    half, advance = half_period_and_precession(moments, w)
    if half[0] == 0.0:
        return motion
    return with_rates(motion, pair_multiple(2.0 * factor, half), advance)
