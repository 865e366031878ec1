# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Quaternions (w, x, y, z) as arrays of any precision."""

import numpy as np


def product(p, q):
    """Return p * q: the rotation q followed by the rotation p."""
    return np.array([p[0] * q[0] - p[1:] @ q[1:],
                     *(p[0] * q[1:] + q[0] * p[1:] + np.cross(p[1:], q[1:]))])


def conjugate(q):
    return np.array([q[0], *-q[1:]])


def rotated(q, a):
    """Return the components in world of a vector in body axes; q: unit quaternion."""
    return product(product(q, np.array([0.0, *a])), conjugate(q))[1:]


def shortest(a, b):
    """Return the shortest rotation from one unit vector to another, not opposite one."""
    q = np.array([1.0 + a @ b, *np.cross(a, b)])
    return q / np.linalg.norm(q)
