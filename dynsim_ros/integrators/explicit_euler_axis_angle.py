# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Explicit Euler (sheet, 4.1 and 4.2), the orientation updated by an axis-angle rotation.

As the sheet has it: R[k + 1] = R_axis-angle R[k], with omega h as axis times angle.
"""

from .explicit_euler import translate
from .memory import load, number_row, store
from ..physics.jit import formula, kernel
from ..physics.motion import accelerations
from ..physics.rotation import axis_angle_matrix, matrix_quaternion, rotation_matrix
from ..physics.state import (counts, moving_size, normalise, omega_at, put_quaternion, quaternion,
                             quaternion_at)
from ..physics.vector import at, matrix_product, scale


@formula
def turn(bodies, rigid, h, y):
    """Turn every rigid body by omega h, in world axes."""
    for i in range(rigid):
        j = quaternion_at(bodies) + 4 * i
        omega = at(y, omega_at(bodies, rigid) + 3 * i)
        q = quaternion(y, j)
        rotation = matrix_product(axis_angle_matrix(scale(h, omega)), rotation_matrix(q))
        w, x, y_, z = matrix_quaternion(rotation)
        # q and -q are one orientation: stay with the nearer one, so that no plot of q jumps.
        sign = -1.0 if q[0] * w + q[1] * x + q[2] * y_ + q[3] * z < 0.0 else 1.0
        put_quaternion(y, j, (sign * w, sign * x, sign * y_, sign * z))


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
