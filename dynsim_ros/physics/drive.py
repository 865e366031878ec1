# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What acts on a scene from outside, in the form that the compiled kernels take."""

from typing import NamedTuple

import numpy as np


class Drive(NamedTuple):
    """
    Anchors, commanded wrenches, and whether work is counted; None for what is absent.

    anchors: (n, 6) position [m] and velocity [m/s] in world at time 0; moving: True, or None where
    all their velocities are zero; pushes: forces [N] and torques [N m], laid out as the state,
    or None; works: True, or None where the works need not be kept.
    """

    anchors: np.ndarray
    moving: bool | None
    pushes: np.ndarray | None
    works: bool | None


def initial_anchors(scene):
    """Return position [m] and velocity [m/s] in world of a scene's anchors at time 0: (n, 6)."""
    return np.array([(*anchor.position, *anchor.velocity) for anchor in scene.anchors],
                    dtype=float).reshape(-1, 6)


def undisturbed_drive(scene, works=None):
    """Return the Drive of a scene that nobody touches."""
    anchors = initial_anchors(scene)
    return Drive(anchors, True if anchors[:, 3:].any() else None, None, works)
