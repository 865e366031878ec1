# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Period and precession of a free rotation with more than twice the digits, in plain Python.

After thousands of turns the rounding of a rate is what is wrong with the orientation. Both rates
are complete elliptic integrals of the first and the third kind, which arithmetic-geometric means
give to any number of digits (DLMF 19.8.5 and 19.8.7; Landau and Lifshitz, Mechanics (1976),
section 37, for the angle of precession in a period).
"""

from decimal import Decimal, localcontext

from .phase import norm_in_two
from .rotate_exactly import rotate_back_exactly
from .torque_free_setup import setup_in_body
from ...physics.vector import transform

_DIGITS = 50
_PI = Decimal('3.14159265358979323846264338327950288419716939937510582')
# The means converge quadratically; a modulus so close to 1 that this does not do has none.
_MOST_MEANS = 60


def in_two(number):
    """Return a Decimal as the sum of two floats."""
    first = float(number)
    return first, float(number - Decimal(first))


def complete_integrals(root, characteristic):
    """
    Return K and Pi of the modulus k and of a characteristic alpha^2 < 1, all Decimals.

    root: the complementary modulus, in (0, 1].
    """
    a, g = Decimal(1), root
    square = 1 - characteristic
    p, weight, total = square.sqrt(), Decimal(1), Decimal(1)
    for _ in range(_MOST_MEANS):
        product = a * g
        ratio = (p * p - product) / (p * p + product)
        p = (p * p + product) / (2 * p)
        weight = weight * ratio / 2
        total += weight
        a, g = (a + g) / 2, product.sqrt()
        if abs(a - g) < Decimal('1e-40') * a and abs(weight) < Decimal('1e-40') * abs(total):
            break
    return (_PI / (2 * a), _PI / (4 * a) * (2 + characteristic / square * total))


def half_period_and_precession(moments, w):
    """
    Return half of the period of u, K / |p|, and half of the angle of precession in it.

    moments: those of e_1, e_2, e_3; w: omega along these, of any sign; all Decimals. None on the
    separatrix, which has no period.
    """
    a, b, c = moments
    along = b * (b - a) * w[1] ** 2 + c * (c - a) * w[2] ** 2
    side = c * (c - b) * w[2] ** 2 - a * (b - a) * w[0] ** 2
    complement = (c - a) * side / ((c - b) * along)
    if not complement > 0:
        return None
    rate = ((c - b) * along / (a * b * c)).sqrt()
    first, third = complete_integrals(complement.sqrt(), -c * (b - a) / (a * (c - b)))
    momentum = (a * a * w[0] ** 2 + b * b * w[1] ** 2 + c * c * w[2] ** 2).sqrt()
    return first / rate, momentum / c * (first + (c - a) / a * third) / rate


def torque_free_in_full(moments, axes, q, omega):
    """
    Return the TorqueFree of torque_free_setup, its rates known to the last bit and beyond.

    Arguments: as for torque_free_setup.
    """
    exact = rotate_back_exactly(q, omega)
    motion = setup_in_body(moments, axes, q, *exact)
    if motion.rate == 0.0:
        rate, left = norm_in_two(omega)
        return motion._replace(precession=0.5 * rate, precession_left=0.5 * left)
    with localcontext() as context:
        context.prec = _DIGITS
        body = [Decimal(first) + Decimal(left) for first, left in zip(*exact)]
        w = transform([[Decimal(part) for part in axis] for axis in axes], body)
        order = 1 if motion.circulation > 0.0 else -1
        found = half_period_and_precession([Decimal(i) for i in moments][::order], w[::order])
        if found is None:
            return motion
        return _with_rates(motion, 2 * found[0], found[1])


def _with_rates(motion, period, advance):
    """
    Return the motion with a period [s] and with half of the angle of precession in it [rad].

    From Euler's angles, of which the latter comes, to chi it is some right angles more or less.
    """
    turn = Decimal(motion.circulation) * Decimal(motion.jacobi.turn)
    rounded = Decimal(motion.precession) * period - turn
    difference = (rounded - advance) / (_PI / 2)
    quarters = difference.to_integral_value()
    # So many turns in a period that rounding hides which: no run lasts that long.
    if abs(difference - quarters) > Decimal('0.1'):
        return motion
    precession, precession_left = in_two((advance + quarters * _PI / 2 + turn) / period)
    period, period_left = in_two(period)
    return motion._replace(period=period, period_left=period_left, precession=precession,
                           precession_left=precession_left)
