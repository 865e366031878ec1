# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The one place where the order of a quaternion's numbers is converted.

Inside the package a quaternion is (w, x, y, z), as on the formula sheet; in ROS messages, in
parameters and in lists in scene files it is x, y, z, w.
"""

import math

# How far from 1 the norm of a given quaternion may be before it is taken for a mistake.
NORM_TOLERANCE = 1e-3


def to_ros(q):
    """Return the (w, x, y, z) quaternion in ROS order (x, y, z, w)."""
    w, x, y, z = q
    return (x, y, z, w)


def from_ros(q):
    """Return the ROS-ordered quaternion (x, y, z, w) as (w, x, y, z)."""
    x, y, z, w = q
    return (w, x, y, z)


def from_axis_angle(axis, angle):
    """
    Return the quaternion (w, x, y, z) of a rotation.

    axis: (3,) direction in world, not zero; angle: [rad].
    """
    x, y, z = axis
    length = math.sqrt(x * x + y * y + z * z)
    half = 0.5 * angle
    return (math.cos(half), *(math.sin(half) * a / length for a in axis))


def unit(q):
    """Return q, of norm 1 to the last bits; raise ValueError if its norm is not close to 1."""
    w, x, y, z = q
    norm = math.sqrt(w * w + x * x + y * y + z * z)
    if not abs(norm - 1.0) <= NORM_TOLERANCE:
        raise ValueError(f'its norm is {norm:.6g}, a unit quaternion is needed, 1 within '
                         f'{NORM_TOLERANCE:g}')
    # Already of norm 1 to the last bit or two: dividing again would move it.
    return q if abs(norm - 1.0) < 4e-16 else tuple(a / norm for a in q)
