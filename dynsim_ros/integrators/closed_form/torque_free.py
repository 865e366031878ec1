# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Rotation of a rigid body on which no moment acts, whatever its inertia.

Along principal axes e, named so that the angular momentum L circles about e_3:
omega = (A_1 cn u, +-A_2 sn u, A_3 dn u), u = p t + v (Landau and Lifshitz, Mechanics (1976),
section 37). The orientation is a turn by an angle chi about L after the smallest rotation that
takes L from where it lies in the body to e_3: chi' = (2 E + L omega_3) / (L + I_3 omega_3),
whose denominator is never small. The integral of chi' is one of the third kind; by theta
functions half of it is a multiple of t and the argument of one complex number (C. G. J. Jacobi,
Sur la rotation d'un corps (1850); R. van Zon and J. Schofield, Numerical implementation of the
exact dynamics of free rigid bodies, J. Comput. Phys. 225 (2007), 145-164).

Energy and angular momentum stay what they are, at all times, by the form of these expressions.
"""

import math
from typing import NamedTuple

from .jacobi import Jacobi, jacobi
from .phase import angle_in_two, cosine_and_sine
from ...physics.jit import formula
from ...physics.rotation import quaternion_product, rotate
from ...physics.two_sum import two_product, two_sum


class TorqueFree(NamedTuple):
    """
    What is computed once for a free rotation, by torque_free_in_full.

    jacobi: the elliptic functions of the motion; rate: p [rad/s]; phase: v; period: of sn^2, that
    is 2 K / p [s], infinite without one; circulation: 1 if e_3 is the axis of the largest moment,
    -1 if it is that of the smallest; precession: what is steady in half of chi' [rad/s];
    period_left, precession_left: what rounding has left out of these; direction, omega: (3,)
    amplitudes along e of L / |L| and of the angular velocity [rad/s]; body: the rotation
    (w, x, y, z) from e to body axes; world: from where L is e_3 to world.
    """

    jacobi: Jacobi
    rate: float
    phase: float
    period: float
    period_left: float
    circulation: float
    precession: float
    precession_left: float
    direction: tuple
    omega: tuple
    body: tuple
    world: tuple


@formula
def conjugate(q):
    """Return the inverse of a unit quaternion."""
    return (q[0], -q[1], -q[2], -q[3])


@formula
def orientation_about_momentum(functions, circulation, angle, left, direction):
    """
    Return the orientation of e as seen along L.

    functions: what jacobi returns; angle, left: two whose sum is what is steady in half of chi
    [rad].
    """
    sn, cn, dn, apart, real, imaginary = functions
    x, y, z = direction[0] * cn, direction[1] * sn, 1.0 + direction[2] * dn
    c, s = cosine_and_sine(angle - circulation * apart, left)
    imaginary *= circulation
    c, s = c * real + s * imaginary, s * real - c * imaginary
    size = math.sqrt((c * c + s * s) * (x * x + y * y + z * z))
    c, s = c / size, s / size
    return (c * z, c * y + s * x, s * y - c * x, s * z)


@formula
def within_period(motion, t, t_left):
    """Return u at time t + t_left, less whole periods 2 K, and the number of these."""
    turns = float(math.floor(
        t / motion.period + (motion.phase * motion.jacobi.inverse_period + 0.5)))
    if turns == 0.0:
        return motion.rate * t + motion.phase, turns
    whole, left = two_product(turns, motion.period)
    rest = (t - whole) + (t_left - left - turns * motion.period_left)
    return motion.rate * rest + motion.phase, turns


@formula
def torque_free(motion, t, t_left=0.0):
    """
    Return orientation (w, x, y, z) and angular velocity (3,) in world [rad/s] at time t + t_left.

    motion: TorqueFree. Any t [s], also negative; the cost does not depend on it.
    """
    u, turns = within_period(motion, t, t_left)
    sn, cn, dn, apart, real, imaginary = jacobi(motion.jacobi, u)
    if 0.5 * turns != math.floor(0.5 * turns):
        sn, cn = -sn, -cn
    angle, left = angle_in_two(motion.precession, motion.precession_left, t, t_left)
    behind, behind_left = two_product(turns, motion.circulation * motion.jacobi.turn)
    angle, rest = two_sum(angle, -behind)
    about = orientation_about_momentum((sn, cn, dn, apart, real, imaginary), motion.circulation,
                                       angle, rest + (left - behind_left), motion.direction)
    axes = quaternion_product(motion.world, about)
    omega = (motion.omega[0] * cn, motion.omega[1] * sn, motion.omega[2] * dn)
    return quaternion_product(axes, conjugate(motion.body)), rotate(axes, omega)
