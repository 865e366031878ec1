# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Semi-implicit Euler: velocities first, then positions and orientations with the new velocities.

Order 1; symplectic where forces depend on positions alone, so that energy errors stay bounded.
"""

from .memory import load, number_row, store
from ..physics.fused import fused
from ..physics.jit import formula, kernel
from ..physics.motion import accelerations
from ..physics.rotation import axis_angle_quaternion, quaternion_product
from ..physics.state import (counts, moving_size, normalise, omega_at, put_quaternion, quaternion,
                             quaternion_at, velocity_at)
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
def advance(model, drive, t_ns, h_ns, steps, state, memory):
    """Take a number of steps of one length; see Method for the arguments."""
    bodies, rigid = counts(model)
    size = moving_size(drive.works, bodies, rigid)
    y = number_row(model.several, memory, 0, size)
    a = number_row(model.several, memory, 1, size)
    load(size, state, y)
    h = h_ns * 1e-9
    removed = 0.0
    for k in range(steps):
        accelerations(model, drive, (t_ns + k * h_ns) * 1e-9, y, a)
        for i in range(velocity_at(bodies), quaternion_at(bodies)):
            y[i] = fused(h, a[i], y[i])
        for i in range(omega_at(bodies, rigid), size):
            y[i] = fused(h, a[i], y[i])
        for i in range(3 * bodies):
            y[i] = fused(h, y[velocity_at(bodies) + i], y[i])
        turn(bodies, rigid, h, y)
        removed += normalise(bodies, rigid, y)
    store(size, y, state)
    return removed
