# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
From inertia, orientation and angular velocity to the constants of a free rotation.

Near the separatrix, where the angular momentum passes the middle axis at a distance d, any error
of the angular velocity grows by up to 1 / d. Which side of the separatrix it is on, and how far
from it, is therefore computed with twice the digits, so that no rounding adds to that of the
state itself; only principal axes that are not the body's axes do, as they are rounded.
"""

import math

from .elliptic import carlson_rf
from .jacobi import circular, jacobi, jacobi_constants
from .rotate_exactly import rotate_back_exactly
from .torque_free import conjugate, orientation_about_momentum, TorqueFree
from ...physics.jit import formula
from ...physics.rotation import matrix_quaternion, quaternion_product
from ...physics.two_sum import two_product, two_sum
from ...physics.vector import norm, scale, transform

# A rotation is steady if omega x (I omega) is smaller than this against |omega| |I omega|, or
# omega below it [rad/s]: far below rounding, and large enough for squares of ratios.
_NOTHING = 1e-100


@formula
def weighted_square(moment, larger, smaller, w, w_left):
    """Return moment (larger - smaller) (w + w_left)^2 as the sum of two numbers."""
    difference, left = two_sum(larger, -smaller)
    factor, factor_left = two_product(moment, difference)
    factor_left += moment * left
    square, square_left = two_product(w, w)
    square_left += 2.0 * w * w_left
    product, product_left = two_product(factor, square)
    return product, product_left + (factor * square_left + factor_left * square)


@formula
def side_of_separatrix(moments, w, left):
    """
    Return L^2 - 2 E I_2: >= 0 if L circles about the axis of I_3, else about that of I_1.

    w, left: two (3,) whose sum is omega along principal axes.
    """
    about_third, third_left = weighted_square(moments[2], moments[2], moments[1], w[2], left[2])
    about_first, first_left = weighted_square(moments[0], moments[1], moments[0], w[0], left[0])
    difference, rest = two_sum(about_third, -about_first)
    return difference + (rest + (third_left - first_left))


@formula
def is_steady(moments, w):
    """Return whether the body turns about a fixed axis: L is along omega, or nearly zero."""
    moment = norm(((moments[1] - moments[2]) * (w[1] * w[2]),
                   (moments[2] - moments[0]) * (w[2] * w[0]),
                   (moments[0] - moments[1]) * (w[0] * w[1])))
    size = norm(w)
    return size < _NOTHING or moment <= _NOTHING * (size * (moments[2] * size))


@formula
def quaternion_to(direction):
    """Return a rotation that takes (0, 0, 1) to a unit vector."""
    x, y, z = direction
    size = math.sqrt(2.0 * (1.0 + abs(z)))
    if z >= 0.0:
        return (0.5 * size, -y / size, x / size, 0.0)
    return (-y / size, 0.5 * size, 0.0, x / size)


@formula
def steady_rotation(q, omega):
    """Return the TorqueFree of a turn about a fixed axis; omega: (3,) in body axes [rad/s]."""
    rate = norm(omega)
    body = (1.0, 0.0, 0.0, 0.0)
    if rate > 0.0:
        body = quaternion_to((omega[0] / rate, omega[1] / rate, omega[2] / rate))
    return TorqueFree(circular(), 0.0, 0.0, math.inf, 0.0, 1.0, 0.5 * rate, 0.0,
                      (0.0, 0.0, 1.0), (0.0, 0.0, rate), body, quaternion_product(q, body))


@formula
def named_axes(moments, axes, w, side):
    """Return moments, axes and components of omega along e, those of e_1 and e_3 >= 0."""
    # Right-handed again by the sign of e_2: first where two axes change places ...
    if side < 0.0:
        moments = (moments[2], moments[1], moments[0])
        axes = (axes[2], scale(-1.0, axes[1]), axes[0])
        w = (w[2], -w[1], w[0])
    # ... then where two of the axes turn round.
    first = -1.0 if w[0] < 0.0 else 1.0
    third = -1.0 if w[2] < 0.0 else 1.0
    axes = (scale(first, axes[0]), scale(first * third, axes[1]), scale(third, axes[2]))
    return moments, axes, (first * w[0], first * third * w[1], third * w[2])


@formula
def transposed(rows):
    """Return the transpose of a matrix of three rows."""
    return ((rows[0][0], rows[1][0], rows[2][0]), (rows[0][1], rows[1][1], rows[2][1]),
            (rows[0][2], rows[1][2], rows[2][2]))


@formula
def phase_at(w, amplitudes):
    """Return v with sn v, cn v >= 0 and dn v > 0 as the ratios of two (3,) (DLMF 19.25.5)."""
    cn, sn, dn = w[0] / amplitudes[0], w[1] / amplitudes[1], w[2] / amplitudes[2]
    size = math.sqrt(cn * cn + sn * sn)
    cn, sn = cn / size, sn / size
    return sn * carlson_rf(cn * cn, dn * dn, 1.0)


@formula
def circling_rotation(moments, w, circulation, side, body, q):
    """
    Return the TorqueFree of a rotation that is not steady.

    moments, w: along e, as named_axes returns them; body: rotation from e to body axes.
    """
    a, b, c = moments
    d12, d13, d23 = abs(b - a), abs(c - a), abs(c - b)
    across = a * d13 * (w[0] * w[0]) + b * d23 * (w[1] * w[1])
    along = b * d12 * (w[1] * w[1]) + c * d13 * (w[2] * w[2])
    omega = (math.sqrt(across / (a * d13)), circulation * math.sqrt(across / (b * d23)),
             math.sqrt(along / (c * d13)))
    momentum = norm((a * w[0], b * w[1], c * w[2]))
    direction = (a * omega[0] / momentum, b * omega[1] / momentum, c * omega[2] / momentum)
    height = direction[0] / (1.0 + direction[2])
    constants = jacobi_constants(d12 * across / (d23 * along), d13 * side / (d23 * along),
                                 height * height)
    phase = phase_at(w, omega)
    rate = math.sqrt(d23 * along / (a * b)) / math.sqrt(c)
    energy = a * w[0] * w[0] + b * w[1] * w[1] + c * w[2] * w[2]
    # half of chi' at u = 0, and how fast the complex number turns from there
    precession = (0.5 * (energy + momentum * omega[2]) / (momentum * (1.0 + direction[2]))
                  + circulation * constants.slope * rate)
    about = orientation_about_momentum(jacobi(constants, phase), circulation, 0.0, 0.0, direction)
    world = quaternion_product(quaternion_product(q, body), conjugate(about))
    period = constants.period / rate if constants.period > 0.0 else math.inf
    return TorqueFree(constants, rate, phase, period, 0.0, circulation, precession, 0.0, direction,
                      omega, body, world)


@formula
def setup_in_body(moments, axes, q, in_body, left):
    """
    Return what torque_free_setup does.

    in_body, left: two (3,) whose sum is omega in body axes [rad/s].
    """
    w = transform(axes, in_body)
    if is_steady(moments, w):
        return steady_rotation(q, in_body)
    side = side_of_separatrix(moments, w, transform(axes, left))
    moments, axes, w = named_axes(moments, axes, w, side)
    circulation = -1.0 if side < 0.0 else 1.0
    return circling_rotation(moments, w, circulation, abs(side),
                             matrix_quaternion(transposed(axes)), q)


@formula
def torque_free_setup(moments, axes, q, omega):
    """
    Return the TorqueFree of a rotation from what is known at time 0.

    moments: three, ascending, > 0 [kg m^2], and axes: three rows, the principal axes in body axes,
    both from principal_axes; q: orientation (w, x, y, z); omega: (3,) in world [rad/s].
    """
    return setup_in_body(moments, axes, q, *rotate_back_exactly(q, omega))
