# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""From a state to forces, accelerations and rates: the right-hand side of the motion."""

from numba import literal_unroll

from .equations_of_motion import (angular_acceleration, linear_acceleration,
                                  scalar_angular_acceleration)
from .forces import apply_linear_drag, apply_rotational_drag, apply_springs
from .jit import formula, kernel
from .rotation import quaternion_rate_world, rotation_matrix
from .state import omega_at, put_quaternion, quaternion, quaternion_at, velocity_at, work_at
from .vector import accumulate, at, put


@formula
def matrix_at(matrices, i):
    """Return the three rows of matrices[i]."""
    return (at(matrices[i, 0], 0), at(matrices[i, 1], 0), at(matrices[i, 2], 0))


@formula
def apply_all_springs(bodies, rigid, springs, anchors, t, y, spring_out, damper_out):
    """Add forces and moments of all springs and dampers."""
    if springs is not None:
        for group in literal_unroll(springs):
            apply_springs(bodies, rigid, group.p, group.q, group.stiffness,
                          group.natural_length, group.epsilon, group.damping, anchors, t, y,
                          spring_out, damper_out)


@formula
def apply_drags(bodies, rigid, linear_drag, rotational_drag, velocity, angular_velocity, y, out):
    """Add those of the two resistances that exist."""
    if linear_drag is not None:
        apply_linear_drag(bodies, rigid, linear_drag, velocity, y, out)
    if rotational_drag is not None:
        apply_rotational_drag(bodies, rigid, rotational_drag, angular_velocity, y, out)


@formula
def apply_air(bodies, rigid, air, y, out):
    """Add forces and torques of the air."""
    if air is not None:
        apply_drags(bodies, rigid, air.linear_drag, air.rotational_drag, air.velocity,
                    air.angular_velocity, y, out)


@formula
def apply_gravity(bodies, weight, out):
    """Add the weights of all bodies."""
    if weight is not None:
        for i in range(bodies):
            accumulate(out, velocity_at(bodies) + 3 * i, at(weight[i], 0))


@formula
def apply_pushes(bodies, rigid, pushes, y, out):
    """Add the commanded forces and torques; pushes: an array laid out as the state."""
    work = work_at(bodies, rigid)
    for i in range(velocity_at(bodies), quaternion_at(bodies)):
        out[i] += pushes[i]
        out[work + 3] += pushes[i] * y[i]
    for i in range(omega_at(bodies, rigid), work):
        out[i] += pushes[i]
        out[work + 3] += pushes[i] * y[i]


@formula
def accelerate_round(bodies, rigid, round_body, round_inertia, out):
    """Turn moments into angular accelerations for the bodies with a scalar inertia."""
    if round_body is not None:
        for i in range(round_body.shape[0]):
            w = omega_at(bodies, rigid) + 3 * round_body[i]
            put(out, w, scalar_angular_acceleration(at(out, w), round_inertia[i]))


@formula
def accelerate_general(bodies, rigid, general_body, inertia, inverse_inertia, y, out):
    """Turn moments into angular accelerations for the bodies with an inertia matrix."""
    if general_body is not None:
        for i in range(general_body.shape[0]):
            w = omega_at(bodies, rigid) + 3 * general_body[i]
            rotation = rotation_matrix(quaternion(y, quaternion_at(bodies) + 4 * general_body[i]))
            put(out, w, angular_acceleration(
                at(out, w), matrix_at(inertia, i), matrix_at(inverse_inertia, i), rotation,
                at(y, w)))


@formula
def accelerations(model, anchors, pushes, t, y, out):
    """
    Write linear and angular accelerations and the powers to out, laid out as the state.

    anchors: (n, 6) position and velocity in world at t = 0; pushes: forces and torques laid out
    as the state; t: [s] since then; y: state. Positions and quaternions of out are not touched.
    """
    bodies = model.mass.shape[0]
    rigid = model.rigid
    out[velocity_at(bodies):quaternion_at(bodies)] = 0.0
    out[omega_at(bodies, rigid):] = 0.0
    apply_pushes(bodies, rigid, pushes, y, out)
    apply_gravity(bodies, model.weight, out)
    apply_all_springs(bodies, rigid, model.springs, anchors, t, y, out, out)
    apply_air(bodies, rigid, model.air, y, out)
    for i in range(bodies):
        v = velocity_at(bodies) + 3 * i
        put(out, v, linear_acceleration(at(out, v), model.mass[i]))
    accelerate_round(bodies, rigid, model.round_body, model.round_inertia, out)
    accelerate_general(bodies, rigid, model.general_body, model.inertia, model.inverse_inertia, y,
                       out)


@formula
def rates(model, anchors, pushes, t, y, out):
    """Write dy/dt to out: the whole right-hand side; arguments as for accelerations."""
    bodies = model.mass.shape[0]
    rigid = model.rigid
    accelerations(model, anchors, pushes, t, y, out)
    for i in range(3 * bodies):
        out[i] = y[velocity_at(bodies) + i]
    for i in range(rigid):
        q = quaternion_at(bodies) + 4 * i
        omega = at(y, omega_at(bodies, rigid) + 3 * i)
        put_quaternion(out, q, quaternion_rate_world(quaternion(y, q), omega))


@kernel
def wrenches(model, anchors, t, y, out):
    """
    Write what each kind of force does to each body; each row of out is laid out as the state.

    out: (4, state_size), zero on entry; rows: spring, damper, air, gravity.
    """
    bodies = model.mass.shape[0]
    apply_all_springs(bodies, model.rigid, model.springs, anchors, t, y, out[0], out[1])
    apply_air(bodies, model.rigid, model.air, y, out[2])
    apply_gravity(bodies, model.weight, out[3])
