# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Explicit Euler (sheet, 4.1 and 4.2), the orientation updated by an axis-angle rotation.

As the sheet has it: R[k + 1] = R_axis-angle R[k], with omega h as axis times angle.
"""

from .explicit_euler import translate
from ..physics.jit import formula, kernel
from ..physics.motion import accelerations
from ..physics.rotation import axis_angle_matrix, matrix_quaternion, rotation_matrix
from ..physics.state import normalise, omega_at, put_quaternion, quaternion, quaternion_at
from ..physics.vector import at, matrix_product, scale


@formula
def turn(bodies, rigid, h, y):
    """Turn every rigid body by omega h, in world axes."""
    for i in range(rigid):
        j = quaternion_at(bodies) + 4 * i
        omega = at(y, omega_at(bodies, rigid) + 3 * i)
        rotation = matrix_product(axis_angle_matrix(scale(h, omega)),
                                  rotation_matrix(quaternion(y, j)))
        put_quaternion(y, j, matrix_quaternion(rotation))


@kernel
def advance(model, anchors, pushes, t_ns, h_ns, steps, y, work):
    """
    Take a number of steps of length h_ns, beginning at time t_ns.

    model: Model; anchors: (n, 6) position [m] and velocity [m/s] in world at time 0; pushes:
    forces [N] and torques [N m] laid out as the state; t_ns, h_ns: integers [ns], so that the
    times of the steps do not depend on how many of them are taken at once; y: state, replaced;
    work: (5, state_size), overwritten.
    Returns the sum over the steps of what normalising the quaternions removed.
    """
    bodies = model.mass.shape[0]
    a = work[0]
    h = h_ns * 1e-9
    removed = 0.0
    for k in range(steps):
        accelerations(model, anchors, pushes, (t_ns + k * h_ns) * 1e-9, y, a)
        turn(bodies, model.rigid, h, y)
        translate(bodies, model.rigid, h, a, y)
        removed += normalise(bodies, model.rigid, y)
    return removed
