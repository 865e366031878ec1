# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Random states of a scene, for what is computed of them to be compared with NewtonEuler."""

import numpy as np
from scipy.spatial.transform import Rotation


def random_state(layout, random):
    """Return a state and the same as NewtonEuler has it."""
    y, motion = np.zeros(layout.size), {}
    for body in layout.bodies:
        y[layout.position(body)], y[layout.velocity(body)] = random.normal(size=(2, 3))
        motion[body] = [y[layout.position(body)], y[layout.velocity(body)]]
        if layout.orientation(body) is not None:
            turn = Rotation.random(None, random)
            y[layout.orientation(body)] = np.roll(turn.as_quat(), 1)
            y[layout.angular_velocity(body)] = 3 * random.normal(size=3)
            motion[body] += [turn, y[layout.angular_velocity(body)].copy()]
    return y, motion


def difference(found, expected):
    """Return the largest difference, relative to the largest expected number."""
    return float(np.abs(np.subtract(found, expected)).max() / np.abs(expected).max())
