# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
States of a scene: positions, velocities, quaternions (w, x, y, z), angular velocities.

Rigid bodies come before particles, and all is in world; but in the state of the equations
themselves the angular velocity of a body that is not round is in its own axes: that is shorter,
and errors of the quaternion's norm cannot grow in it.
"""

from dynsim_ros.scene import Box, Rigid, RigidBody, Sphere
import numpy as np
from quaternions import conjugate, rotated


class Places:
    """Where the parts of the state lie."""

    def __init__(self, scene):
        self.bodies = sorted(scene.bodies, key=lambda body: not isinstance(body, Rigid))
        self.names = [body.name for body in self.bodies]
        self.rigid = sum(isinstance(body, Rigid) for body in self.bodies)
        self.size = 6 * len(self.bodies) + 7 * self.rigid

    def position(self, i):
        return slice(3 * i, 3 * i + 3)

    def velocity(self, i):
        start = 3 * len(self.bodies) + 3 * i
        return slice(start, start + 3)

    def orientation(self, i):
        start = 6 * len(self.bodies) + 4 * i
        return slice(start, start + 4)

    def angular_velocity(self, i):
        start = 6 * len(self.bodies) + 4 * self.rigid + 3 * i
        return slice(start, start + 3)


def initial(scene):
    """Return the state at the start, in world: (size,)."""
    bodies = Places(scene).bodies
    rigid = [body for body in bodies if isinstance(body, Rigid)]
    parts = [[body.position for body in bodies], [body.velocity for body in bodies],
             [body.orientation for body in rigid], [body.angular_velocity for body in rigid]]
    return np.concatenate([np.ravel(np.array(part, dtype=float)) for part in parts])


def in_equations(scene, y):
    """Return a state, or several, of the equations from those in world."""
    return _turned(scene, y, conjugate)


def in_world(scene, y):
    """Return a state, or several, in world from those of the equations."""
    return _turned(scene, y, lambda q: q / np.sqrt(q @ q))


def _turned(scene, y, turn):
    y, places = np.array(y), Places(scene)
    for i, body in enumerate(places.bodies[:places.rigid]):
        if not is_round(body):
            part = places.angular_velocity(i)
            for row in y.reshape(-1, places.size):
                row[part] = rotated(turn(row[places.orientation(i)]), row[part])
    return y


def start(scene):
    """Return the state of the equations at the start: (size,)."""
    return in_equations(scene, initial(scene))


def moments_of_inertia(body):
    """Return the inertia about the centre of mass in body axes: (3, 3) [kg m^2]."""
    if isinstance(body, Sphere):
        return np.diag([0.4 * body.mass * body.radius * body.radius] * 3)
    if isinstance(body, Box):
        squares = np.square(body.size)
        return np.diag(body.mass / 12 * (squares.sum() - squares))
    assert isinstance(body, RigidBody)
    inertia = np.asarray(body.inertia)
    return inertia if inertia.ndim == 2 else np.diag(inertia * np.ones(3))


def is_round(body):
    """Return whether the inertia is the same about every axis."""
    inertia = moments_of_inertia(body)
    return np.array_equal(inertia, inertia[0, 0] * np.eye(3))
