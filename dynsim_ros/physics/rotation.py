# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Orientation: quaternions (w, x, y, z), rotation matrices, and how they change (sheet, 4.2).

A quaternion q and the matrix R(q) turn components in body axes into components in world axes.
"""

import math

from .elementary import sine_cosine
from .fused import fused
from .jit import formula
from .lanes import root
from .vector import cross, dot, norm, scale


@formula
def rotation_matrix(q):
    """Return R (three rows) of the unit quaternion q; the columns are b_x, b_y, b_z in world."""
    w, x, y, z = q
    return ((fused(-2.0, fused(y, y, z * z), 1.0), 2.0 * fused(x, y, -w * z),
             2.0 * fused(x, z, w * y)),
            (2.0 * fused(x, y, w * z), fused(-2.0, fused(x, x, z * z), 1.0),
             2.0 * fused(y, z, -w * x)),
            (2.0 * fused(x, z, -w * y), 2.0 * fused(y, z, w * x),
             fused(-2.0, fused(x, x, y * y), 1.0)))


@formula
def rotate(q, a):
    """Return the components in world of a vector a in body axes; q: unit quaternion."""
    w = q[0]
    u = (q[1], q[2], q[3])
    c = cross(u, a)
    d = cross(u, c)
    return (fused(2.0, fused(w, c[0], d[0]), a[0]), fused(2.0, fused(w, c[1], d[1]), a[1]),
            fused(2.0, fused(w, c[2], d[2]), a[2]))


@formula
def quaternion_rate(q, omega):
    """
    Return dq/dt = H omega / 2 (sheet, 4.2), H as printed there.

    q: unit quaternion (w, x, y, z); omega: (3,) angular velocity in BODY axes [rad/s]. With the
    printed H the components must be those along the body's axes: H omega is then the quaternion
    product q * (0, omega), and agrees with the axis-angle update, which takes world components.
    """
    w, x, y, z = q
    a, b, c = omega
    return (0.5 * (-x * a - y * b - z * c), 0.5 * (w * a - z * b + y * c),
            0.5 * (z * a + w * b - x * c), 0.5 * (-y * a + x * b + w * c))


@formula
def quaternion_rate_world(q, omega):
    """Return dq/dt = (0, omega) * q / 2; omega: (3,) angular velocity in WORLD axes [rad/s]."""
    w, x, y, z = q
    a, b, c = scale(0.5, omega)
    return (fused(-x, a, fused(-y, b, -z * c)), fused(w, a, fused(z, b, -y * c)),
            fused(w, b, fused(-z, a, x * c)), fused(y, a, fused(-x, b, w * c)))


@formula
def quaternion_norm(q):
    """Return sqrt(w^2 + x^2 + y^2 + z^2) (sheet, 4.2)."""
    return root(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])


@formula
def axis_angle_matrix(rotation):
    """
    Return the rotation matrix (three rows) of an axis-angle vector, by Rodrigues' formula.

    rotation: (3,) axis times angle [rad], in world; for a step of length h: omega h.
    """
    angle = norm(rotation)
    x, y, z = rotation
    # sin(angle) / angle and (1 - cos(angle)) / angle^2; their series where these lose digits.
    if angle > 1e-4:
        sine, cosine = sine_cosine(0.5 * angle)
        half = sine / angle
        s = 2.0 * half * cosine
        c = 2.0 * half * half
    else:
        s = 1.0 - angle * angle / 6.0
        c = 0.5 - angle * angle / 24.0
    return ((1.0 - c * (y * y + z * z), c * x * y - s * z, c * x * z + s * y),
            (c * x * y + s * z, 1.0 - c * (x * x + z * z), c * y * z - s * x),
            (c * x * z - s * y, c * y * z + s * x, 1.0 - c * (x * x + y * y)))


@formula
def axis_angle_quaternion(rotation):
    """Return the unit quaternion of an axis-angle vector; rotation: (3,) as above [rad]."""
    angle = norm(rotation)
    sine, cosine = sine_cosine(0.5 * angle)
    if angle > 1e-4:
        s = sine / angle
    else:
        s = 0.5 - angle * angle / 48.0
    return (cosine, s * rotation[0], s * rotation[1], s * rotation[2])


@formula
def quaternion_product(p, q):
    """Return p * q: the rotation q followed by the rotation p, both in world."""
    u = (p[1], p[2], p[3])
    v = (q[1], q[2], q[3])
    c = cross(u, v)
    return (p[0] * q[0] - dot(u, v), p[0] * v[0] + q[0] * u[0] + c[0],
            p[0] * v[1] + q[0] * u[1] + c[1], p[0] * v[2] + q[0] * u[2] + c[2])


@formula
def matrix_quaternion(m):
    """Return the unit quaternion of a rotation matrix (three rows), w >= 0 (Shepperd)."""
    trace = m[0][0] + m[1][1] + m[2][2]
    if trace >= max(m[0][0], m[1][1], m[2][2]):
        w = 0.5 * math.sqrt(1.0 + trace)
        v = scale(0.25 / w, (m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]))
        return (w, v[0], v[1], v[2])
    if m[0][0] >= max(m[1][1], m[2][2]):
        x = 0.5 * math.sqrt(1.0 + m[0][0] - m[1][1] - m[2][2])
        w, y, z = scale(0.25 / x, (m[2][1] - m[1][2], m[0][1] + m[1][0], m[0][2] + m[2][0]))
    elif m[1][1] >= m[2][2]:
        y = 0.5 * math.sqrt(1.0 - m[0][0] + m[1][1] - m[2][2])
        w, x, z = scale(0.25 / y, (m[0][2] - m[2][0], m[0][1] + m[1][0], m[1][2] + m[2][1]))
    else:
        z = 0.5 * math.sqrt(1.0 - m[0][0] - m[1][1] + m[2][2])
        w, x, y = scale(0.25 / z, (m[1][0] - m[0][1], m[0][2] + m[2][0], m[1][2] + m[2][1]))
    sign = -1.0 if w < 0.0 else 1.0
    return (sign * w, sign * x, sign * y, sign * z)
