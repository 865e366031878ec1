# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The cells of the grids: a sphere on a spring-damper in air, its parameters far and wide.

The sphere is let go with the spring at its natural length, moving and spinning: what it does then
follows from its parameters, and not from a huge energy stored in a stiff spring.
"""

from dataclasses import dataclass, replace
import math

from cases import Case, GRAVITY, hung, sphere, turned
from dynsim_ros.scene import Air
import numpy as np
from quaternions import rotated
from states import moments_of_inertia, Places

DURATION = 0.1
ANCHOR, NATURAL_LENGTH = np.array([0.0, 0.0, 2.0]), 0.5
# From the anchor to where the spring meets the sphere.
DIRECTION = np.array([0.3, 0.0, -0.8]) / math.sqrt(0.73)
SPIN_AXIS = np.array([1.0, 2.0, 3.0]) / math.sqrt(14.0)

VALUES = {
    'stiffness': (1e-3, 1.0, 1e2, 1e4, 1e6, 1e8, 1e10, 1e12),
    'damping': (0.0, 1e-2, 1.0, 1e2, 1e3, 1e4, 1e6),
    'mass': (1e-6, 1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6),
    'radius': (1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0),
    'spin': (0.0, 1.0, 10.0, 1e2, 1e3, 1e4, 1e5),
    'step': (1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1)}
UNITS = {'stiffness': 'N/m', 'damping': 'N s/m', 'mass': 'kg', 'radius': 'm', 'spin': 'rad/s',
         'step': 's'}
GRIDS = (('stiffness', 'mass'), ('stiffness', 'damping'), ('stiffness', 'step'),
         ('radius', 'spin'), ('mass', 'damping'))


@dataclass(frozen=True)
class Parameters:
    """What varies from cell to cell; step [s]: of the methods of fixed step."""

    stiffness: float = 100.0
    damping: float = 0.5
    mass: float = 1.0
    radius: float = 0.1
    spin: float = math.sqrt(14.0)
    step: float = 1e-3


def grid(columns, rows):
    """Return the Parameters of a grid, row by row."""
    return [replace(Parameters(), **{columns: x, rows: y})
            for y in VALUES[rows] for x in VALUES[columns]]


def case_of(parameters, change=0.0):
    """
    Return the Case of a cell.

    change: added to all parts of the state at the start, each over max(1, its size).
    """
    tilt = turned((1.0, 0.0, 0.0), 0.3)
    place = ANCHOR + NATURAL_LENGTH * DIRECTION
    position = place - rotated(np.array(tilt), np.array([0.0, 0.0, parameters.radius]))
    spin = parameters.spin + change * max(1.0, parameters.spin)
    body = sphere(parameters.mass, parameters.radius, tuple(map(float, position + change)),
                  (change, 0.5 + change, change), tilt, tuple(map(float, spin * SPIN_AXIS)))
    scene = hung(body, stiffness=parameters.stiffness, natural_length=NATURAL_LENGTH,
                 damping=parameters.damping, air=Air(linear_drag=0.1, rotational_drag=1e-3))
    return Case('cell', scene, DURATION, '')


def energy(scene, y):
    """Return the mechanical energy of a sphere on a spring [J]."""
    places, body, spring = Places(scene), scene.bodies[0], scene.springs[0]
    x, v = y[places.position(0)], y[places.velocity(0)]
    q, omega = y[places.orientation(0)], y[places.angular_velocity(0)]
    end = x + rotated(q, np.array(body.default_offset))
    stretch = np.linalg.norm(end - np.array(scene.anchors[0].position)) - spring.natural_length
    weight = body.mass * (scene.gravity or 0.0)
    return float(0.5 * body.mass * v @ v + 0.5 * moments_of_inertia(body)[0, 0] * omega @ omega
                 + 0.5 * spring.stiffness * stretch * stretch - weight * x @ np.array(scene.down))


def energy_scale(scene, y0):
    """Return what changes are compared with [J]: the energy at the start, and of a small fall."""
    places, body = Places(scene), scene.bodies[0]
    height = -y0[places.position(0)] @ np.array(scene.down)
    weight = body.mass * (scene.gravity or 0.0)
    return energy(scene, y0) - weight * height + 0.5 * body.mass * GRAVITY
