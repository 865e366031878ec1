# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
From a state to forces, accelerations and rates: the right-hand side of the motion.

States are arrays or Cells, of numbers or of Lanes. Absent terms (None) are not in the code.
"""

from numba import literal_unroll

from .equations_of_motion import (angular_acceleration, linear_acceleration,
                                  scalar_angular_acceleration)
from .forces import apply_linear_drag, apply_rotational_drag, apply_springs
from .jit import formula
from .rotation import quaternion_rate_world, rotation_matrix
from .state import (counts, moving_size, omega_at, put_quaternion, quaternion, quaternion_at,
                    velocity_at, work_at)
from .vector import accumulate, at, put


@formula
def matrix_at(matrices, i):
    """Return the three rows of matrices[i]."""
    return (at(matrices[i, 0], 0), at(matrices[i, 1], 0), at(matrices[i, 2], 0))


@formula
def apply_all_springs(several, connections, bodies, rigid, springs, anchors, moving, works, t, y,
                      out):
    """Add forces and moments of all springs with their dampers."""
    if springs is not None:
        for group in literal_unroll(springs):
            apply_springs(several, connections, bodies, rigid, group.p, group.q, group.stiffness,
                          group.natural_length, group.epsilon, group.damping, group.is_kept,
                          anchors, moving, works, t, y, out)


@formula
def apply_drags(bodies, rigid, linear_drag, rotational_drag, velocity, angular_velocity, works, y,
                out):
    """Add those of the two resistances that exist."""
    if linear_drag is not None:
        apply_linear_drag(bodies, rigid, linear_drag, velocity, works, y, out)
    if rotational_drag is not None:
        apply_rotational_drag(bodies, rigid, rotational_drag, angular_velocity, works, y, out)


@formula
def apply_air(bodies, rigid, air, works, y, out):
    """Add forces and torques of the air."""
    if air is not None:
        apply_drags(bodies, rigid, air.linear_drag, air.rotational_drag, air.velocity,
                    air.angular_velocity, works, y, out)


@formula
def apply_gravity(bodies, weight, out):
    """Add the weights of all bodies."""
    if weight is not None:
        for i in range(bodies):
            accumulate(out, velocity_at(bodies) + 3 * i, at(weight[i], 0))


@formula
def count_push_work(works, work, push, velocity, out):
    """Add the power of a commanded force or torque along one axis, if works are counted."""
    if works is not None:
        out[work + 3] = out[work + 3] + push * velocity


@formula
def apply_pushes(bodies, rigid, pushes, works, y, out):
    """Add the commanded forces and torques; pushes: an array laid out as the state."""
    if pushes is not None:
        work = work_at(bodies, rigid)
        for i in range(velocity_at(bodies), quaternion_at(bodies)):
            out[i] = out[i] + pushes[i]
            count_push_work(works, work, pushes[i], y[i], out)
        for i in range(omega_at(bodies, rigid), work):
            out[i] = out[i] + pushes[i]
            count_push_work(works, work, pushes[i], y[i], out)


@formula
def accelerate_round(several, bodies, rigid, round_body, round_inertia, out):
    """Turn moments into angular accelerations for the bodies with a scalar inertia."""
    if round_body is not None:
        for k in range(chosen(several, round_body)):
            w = omega_at(bodies, rigid) + 3 * member(several, round_body, k)
            put(out, w, scalar_angular_acceleration(at(out, w), round_inertia[k]))


@formula
def chosen(several, index):
    """Return how many bodies an index holds; known when compiled for a single body."""
    if several is not None:
        return index.shape[0]
    return 1


@formula
def member(several, index, k):
    """Return entry k of an index of bodies; known when compiled for a single body."""
    if several is not None:
        return index[k]
    return 0


@formula
def accelerate_general(several, bodies, rigid, general_body, inertia, inverse_inertia, y, out):
    """Turn moments into angular accelerations for the bodies with an inertia matrix."""
    if general_body is not None:
        for k in range(chosen(several, general_body)):
            i = member(several, general_body, k)
            w = omega_at(bodies, rigid) + 3 * i
            rotation = rotation_matrix(quaternion(y, quaternion_at(bodies) + 4 * i))
            put(out, w, angular_acceleration(
                at(out, w), matrix_at(inertia, k), matrix_at(inverse_inertia, k), rotation,
                at(y, w)))


@formula
def apply_forces(model, drive, t, y, out):
    """Write forces, moments and powers to out; arguments as for rates."""
    bodies, rigid = counts(model)
    # -0 and not 0: adding to it changes no number, so that the compiler leaves the addition out.
    for i in range(velocity_at(bodies), quaternion_at(bodies)):
        out[i] = -0.0
    for i in range(omega_at(bodies, rigid), moving_size(drive.works, bodies, rigid)):
        out[i] = -0.0
    apply_pushes(bodies, rigid, drive.pushes, drive.works, y, out)
    apply_gravity(bodies, model.weight, out)
    apply_air(bodies, rigid, model.air, drive.works, y, out)
    # Last, because they take longest to come.
    apply_all_springs(model.several, model.connections, bodies, rigid, model.springs,
                      drive.anchors, drive.moving, drive.works, t, y, out)


@formula
def accelerations(model, drive, t, y, out):
    """
    Write linear and angular accelerations and the powers to out, laid out as the state.

    model: Model; drive: Drive; t: [s] since the anchors were as the drive has them; y: state.
    Positions and quaternions of out are not touched.
    """
    bodies, rigid = counts(model)
    apply_forces(model, drive, t, y, out)
    for i in range(bodies):
        v = velocity_at(bodies) + 3 * i
        put(out, v, linear_acceleration(at(out, v), model.mass[i]))
    accelerate_round(model.several, bodies, rigid, model.round_body, model.round_inertia, out)
    accelerate_general(model.several, bodies, rigid, model.general_body, model.inertia,
                       model.inverse_inertia, y, out)


@formula
def rates(model, drive, t, y, out):
    """Write dy/dt to out: the whole right-hand side; arguments as for accelerations."""
    bodies, rigid = counts(model)
    accelerations(model, drive, t, y, out)
    for i in range(3 * bodies):
        out[i] = y[velocity_at(bodies) + i]
    for i in range(rigid):
        q = quaternion_at(bodies) + 4 * i
        omega = at(y, omega_at(bodies, rigid) + 3 * i)
        put_quaternion(out, q, quaternion_rate_world(quaternion(y, q), omega))
