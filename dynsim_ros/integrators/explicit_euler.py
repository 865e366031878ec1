# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Explicit Euler (sheet, 4.1 and 4.2), the quaternion updated by the matrix H and normalised.

Order 1; simple, and poor: energy grows. For comparison and teaching.
"""

from .memory import load, number_row, store
from ..physics.fused import fused
from ..physics.jit import formula, kernel
from ..physics.motion import accelerations
from ..physics.rotation import quaternion_rate, rotation_matrix
from ..physics.state import (counts, moving_size, normalise, omega_at, put_quaternion, quaternion,
                             quaternion_at, velocity_at)
from ..physics.vector import at, transform_back


@formula
def turn(bodies, rigid, h, y):
    """Write q[k + 1] = q[k] + h H omega[k] / 2 for every rigid body; normalise is to follow."""
    for i in range(rigid):
        j = quaternion_at(bodies) + 4 * i
        q = quaternion(y, j)
        omega = at(y, omega_at(bodies, rigid) + 3 * i)
        rate = quaternion_rate(q, transform_back(rotation_matrix(q), omega))
        put_quaternion(y, j, (fused(h, rate[0], q[0]), fused(h, rate[1], q[1]),
                              fused(h, rate[2], q[2]), fused(h, rate[3], q[3])))


@formula
def translate(bodies, rigid, size, h, a, y):
    """Write positions, velocities, angular velocities and works of step k + 1; all use step k."""
    for i in range(3 * bodies):
        y[i] = fused(h, y[velocity_at(bodies) + i], y[i])
    for i in range(velocity_at(bodies), quaternion_at(bodies)):
        y[i] = fused(h, a[i], y[i])
    for i in range(omega_at(bodies, rigid), size):
        y[i] = fused(h, a[i], y[i])


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
        turn(bodies, rigid, h, y)
        translate(bodies, rigid, size, h, a, y)
        removed += normalise(bodies, rigid, y)
    store(size, y, state)
    return removed
