# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The error of a state.

The largest, over all bodies, of |dx| [m], |dv| [m/s], the angle between the orientations [rad] and
|d omega| [rad/s], each over max(1, the size of that part of the reference); for the angle over 1.
"""

import numpy as np
from states import Places


def error(scene, y, expected):
    """
    Return the error of a state, or the largest of several.

    y: (size,) or (n, size), in world, laid out as in states.py; expected: the true ones.
    """
    real = np.longdouble
    y, expected = np.asarray(y, real), np.asarray(expected, real)
    if y.shape != expected.shape or not np.isfinite(y).all():
        return np.inf
    places = Places(scene)
    parts = [place(i) for place in (places.position, places.velocity)
             for i in range(len(places.bodies))]
    parts += [places.angular_velocity(i) for i in range(places.rigid)]
    errors = [norm(y[..., part] - expected[..., part]) / np.maximum(1, norm(expected[..., part]))
              for part in parts]
    errors += [angle(y[..., part], expected[..., part])
               for part in map(places.orientation, range(places.rigid))]
    worst = float(np.max(errors))
    return worst if np.isfinite(worst) else np.inf


def norm(a):
    return np.sqrt((a * a).sum(axis=-1))


def angle(p, q):
    """Return the angle of the rotation between two quaternions [rad]."""
    p, q = p / norm(p)[..., None], q / norm(q)[..., None]
    w = (p * q).sum(axis=-1)
    s = p[..., :1] * q[..., 1:] - q[..., :1] * p[..., 1:] + np.cross(p[..., 1:], q[..., 1:])
    return 2 * np.arctan2(norm(s), abs(w))
