# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Where each body and anchor of a scene is in the arrays of the kernels."""

from ..physics.model import body_order
from ..physics.state import state_size
from ..scene import Rigid


class Layout:
    """
    Names to places, for one scene.

    bodies: names in the order of the model; rigid: how many of them, the first ones, can rotate;
    anchors: names; size: length of the state array.
    """

    def __init__(self, scene):
        order = body_order(scene)
        self.bodies = [body.name for body in order]
        self.rigid = sum(isinstance(body, Rigid) for body in order)
        self.anchors = [anchor.name for anchor in scene.anchors]
        self.size = state_size(len(order), self.rigid)

    def position(self, body):
        """Return the slice of where a body's centre of mass is."""
        i = 3 * self.bodies.index(body)
        return slice(i, i + 3)

    def velocity(self, body):
        """Return the slice of a body's velocity; in arrays of forces, of the force on it."""
        i = 3 * (len(self.bodies) + self.bodies.index(body))
        return slice(i, i + 3)

    def orientation(self, body):
        """Return the slice of a rigid body's quaternion (w, x, y, z); None for a particle."""
        i = self.bodies.index(body)
        start = 6 * len(self.bodies) + 4 * i
        return slice(start, start + 4) if i < self.rigid else None

    def angular_velocity(self, body):
        """Return the slice of a rigid body's angular velocity (or torque); None for a particle."""
        i = self.bodies.index(body)
        start = 6 * len(self.bodies) + 4 * self.rigid + 3 * i
        return slice(start, start + 3) if i < self.rigid else None

    @property
    def work(self):
        """Return the slice of the works done so far."""
        return slice(6 * len(self.bodies) + 7 * self.rigid, self.size)
