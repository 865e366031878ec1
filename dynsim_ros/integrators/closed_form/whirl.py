# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Rotation of a body with scalar inertia in air that whirls about another axis than it spins.

The angular velocity is w + d z with z = exp(-c t): that of the air, and what decays of the
difference. As a function of z the orientation obeys a linear equation with a regular singular
point at z = 0, dq/dz = -(w / z + d) q / (2 c), whose solution is a power series times a power:
q = F(z) exp(w t / 2) C, with a constant quaternion C and F(0) = 1. The series converges for every
z; but its terms grow with |d| / (2 c) before they fall, and their rounding with them. It is
therefore for spins that the air stops within a turn or two, see `reaches`.

Source: the method of Frobenius, DLMF 2.7(i); products are those of quaternions.
"""

from .spin import free_spin
from ...physics.elementary import exponential
from ...physics.jit import formula
from ...physics.rotation import quaternion_norm, quaternion_product
from ...physics.state import put_quaternion, quaternion
from ...physics.vector import add, cross, dot, norm, scale, subtract

# The most that |d| / (2 c) may be [rad], and so many terms leave out less than 1e-17 then.
_MOST_TURN, TERMS = 5.0, 38


def reaches(angular_velocity, whirl, decay):
    """Return whether the series does; (3,) in world [rad/s], decay: c = drag / inertia [1/s]."""
    return norm(subtract(angular_velocity, whirl)) <= 2.0 * decay * _MOST_TURN


@formula
def whirl_series(angular_velocity, whirl, decay, series):
    """
    Write the coefficients of F, quaternions (w, x, y, z), to series: (TERMS, 4).

    angular_velocity, whirl, decay: as above.
    """
    d = scale(-0.5 / decay, subtract(angular_velocity, whirl))
    axis = scale(1.0 / decay, whirl)
    square = dot(axis, axis)
    put_quaternion(series[0], 0, (1.0, 0.0, 0.0, 0.0))
    for k in range(1, TERMS):
        n = float(k)
        s, x, y, z = quaternion_product((0.0, d[0], d[1], d[2]), quaternion(series[k - 1], 0))
        r = (x, y, z)
        # n v + axis x v = r
        v = add(scale(n, subtract(scale(n, r), cross(axis, r))), scale(dot(axis, r), axis))
        v = scale(1.0 / (n * (n * n + square)), v)
        put_quaternion(series[k], 0, (s / n, v[0], v[1], v[2]))


@formula
def terms_needed(x):
    """Return an even number of terms that suffices; x: c t, so that z = exp(-x)."""
    # (5 z)^n / n! is below 1e-18 from there on.
    if x < 1.0:
        return TERMS
    if x < 3.0:
        return 28
    if x < 6.0:
        return 16
    return 10


@formula
def sum_of_series(series, x):
    """Return F(exp(-x)), even and odd powers side by side; series: (TERMS, 4) array, x >= 0."""
    z, _ = exponential(-x)
    square = z * z
    a, b, c, d, e, f, g, h = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for n in range(terms_needed(x) - 2, -1, -2):
        a = a * square + series[n, 0]
        b = b * square + series[n, 1]
        c = c * square + series[n, 2]
        d = d * square + series[n, 3]
        e = e * square + series[n + 1, 0]
        f = f * square + series[n + 1, 1]
        g = g * square + series[n + 1, 2]
        h = h * square + series[n + 1, 3]
    return (a + z * e, b + z * f, c + z * g, d + z * h)


@formula
def whirled(t, series, constant, whirl, decay, t_left=0.0):
    """Return the orientation (w, x, y, z) at time t + t_left >= 0; constant: (4,) C."""
    steady, _ = free_spin(t, quaternion(constant, 0), whirl, t_left)
    q = quaternion_product(sum_of_series(series, decay * t), steady)
    size = 1.0 / quaternion_norm(q)
    return (size * q[0], size * q[1], size * q[2], size * q[3])


@formula
def constant_of_whirl(series, orientation):
    """Return the quaternion C (w, x, y, z) that gives the orientation at time 0."""
    w, x, y, z = 0.0, 0.0, 0.0, 0.0
    # the small ones first
    for k in range(TERMS - 1, -1, -1):
        a, b, c, d = quaternion(series[k], 0)
        w, x, y, z = w + a, x + b, y + c, z + d
    q = quaternion_product((w, -x, -y, -z), orientation)
    size = quaternion_norm(q)
    return (q[0] / size, q[1] / size, q[2] / size, q[3] / size)
