# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Semi-implicit Euler: velocities first, then positions and orientations with the new velocities.

Order 1; symplectic where forces depend on positions alone, so that energy errors stay bounded.
"""

from ..physics.jit import formula, kernel
from ..physics.motion import accelerations
from ..physics.rotation import axis_angle_quaternion, quaternion_product
from ..physics.state import (normalise, omega_at, put_quaternion, quaternion, quaternion_at,
                             velocity_at)
from ..physics.vector import at, scale


@formula
def turn(bodies, rigid, h, y):
    """Turn every rigid body by omega h, in world axes."""
    for i in range(rigid):
        j = quaternion_at(bodies) + 4 * i
        omega = at(y, omega_at(bodies, rigid) + 3 * i)
        put_quaternion(y, j, quaternion_product(axis_angle_quaternion(scale(h, omega)),
                                                quaternion(y, j)))


@kernel
def advance(model, anchors, pushes, t_ns, h_ns, steps, y, scratch):
    """Take a number of steps of one length; see Method for the arguments."""
    bodies = model.mass.shape[0]
    rigid = model.rigid
    a = scratch[0]
    h = h_ns * 1e-9
    removed = 0.0
    for k in range(steps):
        accelerations(model, anchors, pushes, (t_ns + k * h_ns) * 1e-9, y, a)
        for i in range(velocity_at(bodies), quaternion_at(bodies)):
            y[i] += h * a[i]
        for i in range(omega_at(bodies, rigid), y.shape[0]):
            y[i] += h * a[i]
        for i in range(3 * bodies):
            y[i] += h * y[velocity_at(bodies) + i]
        turn(bodies, rigid, h, y)
        removed += normalise(bodies, rigid, y)
    return removed
