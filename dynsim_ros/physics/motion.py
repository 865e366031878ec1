# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
From a state to forces, accelerations and rates: the right-hand side of the motion.

States are arrays or Cells, of numbers or of Lanes. Absent terms (None) are not in the code.
"""

from numba import types

from .advancing import put_angular_acceleration, put_linear_acceleration
from .each import each
from .equations_of_motion import angular_acceleration
from .forces import (apply_springs, begin_works, put_powers, with_linear_drag, with_push,
                     with_rotational_drag, with_weight)
from .jit import formula, overload
from .rotation import quaternion_rate_world, rotation_matrix
from .state import (counts, omega_at, put_quaternion, quaternion, quaternion_at, velocity_at,
                    work_at)
from .vector import at, put


@formula
def matrix_at(matrices, i):
    """Return the three rows of matrices[i]."""
    return (at(matrices[i, 0], 0), at(matrices[i, 1], 0), at(matrices[i, 2], 0))


def apply_all_springs(several, connections, bodies, rigid, springs, anchors, moving, works, t, y,
                      out):
    """Add forces and moments of all springs with their dampers."""
    for group in springs or ():
        apply_group(several, connections, bodies, rigid, group, anchors, moving, works, t, y, out)


@overload(apply_all_springs)
def _apply_all_springs(several, connections, bodies, rigid, springs, anchors, moving, works, t, y,
                       out):
    return each(apply_all_springs,
                'apply_group(several, connections, bodies, rigid, springs[{i}], anchors, moving, '
                'works, t, y, out)', 0 if isinstance(springs, types.NoneType) else len(springs))


@formula
def apply_group(several, connections, bodies, rigid, group, anchors, moving, works, t, y, out):
    """Add forces and moments of one SpringGroup."""
    apply_springs(several, connections, bodies, rigid, group.p, group.q, group.stiffness,
                  group.natural_length, group.epsilon, group.damping, group.reach_at,
                  group.is_kept, anchors, moving, works, t, y, out)


@formula
def in_air(air, v, works, work, y, force, out):
    """Return a force (3,) with the air's on a body whose velocity is at v, and count its power."""
    if air is not None:
        return with_linear_drag(air.linear_drag, air.velocity, v, works, work, y, force, out)
    return force


@formula
def turning_in_air(air, w, works, work, y, moment, out):
    """Return likewise a moment (3,) of one whose angular velocity is at w."""
    if air is not None:
        return with_rotational_drag(air.rotational_drag, air.angular_velocity, w, works, work, y,
                                    moment, out)
    return moment


@formula
def put_from_outside(bodies, rigid, weight, air, pushes, works, y, out):
    """Write what acts on the bodies but for springs: pushes, weights and air; and their works."""
    work = work_at(bodies, rigid)
    begin_works(works, work, out)
    for i in range(bodies):
        v = velocity_at(bodies) + 3 * i
        # -0 and not 0: adding to it changes no number, so that the compiler leaves that out.
        pushed = with_push(pushes, v, works, work, y, (-0.0, -0.0, -0.0), out)
        put(out, v, in_air(air, v, works, work, y, with_weight(weight, i, pushed), out))
    for i in range(rigid):
        w = omega_at(bodies, rigid) + 3 * i
        pushed = with_push(pushes, w, works, work, y, (-0.0, -0.0, -0.0), out)
        put(out, w, turning_in_air(air, w, works, work, y, pushed, out))


@formula
def accelerate_round(several, bodies, rigid, round_body, inverse_inertia, forces, out):
    """Write angular accelerations of the bodies with a scalar inertia; forces: with moments."""
    if round_body is not None:
        for k in range(chosen(several, round_body)):
            w = omega_at(bodies, rigid) + 3 * member(several, round_body, k)
            put_angular_acceleration(out, w, at(forces, w), inverse_inertia[k])


@formula
def chosen(several, index):
    """Return how many bodies an index holds; known when compiled for a single body."""
    if several is not None:
        return len(index)
    return 1


@formula
def member(several, index, k):
    """Return entry k of an index of bodies; known when compiled for a single body."""
    if several is not None:
        return index[k]
    return 0


@formula
def accelerate_general(several, bodies, rigid, general_body, inertia, inverse_inertia, y, forces,
                       out):
    """Write angular accelerations of the bodies with an inertia matrix."""
    if general_body is not None:
        for k in range(chosen(several, general_body)):
            i = member(several, general_body, k)
            w = omega_at(bodies, rigid) + 3 * i
            rotation = rotation_matrix(quaternion(y, quaternion_at(bodies) + 4 * i))
            put(out, w, angular_acceleration(
                at(forces, w), matrix_at(inertia, k), matrix_at(inverse_inertia, k), rotation,
                at(y, w)))


@formula
def apply_forces(model, drive, t, y, out):
    """Write forces, moments and powers to out; arguments as for rates."""
    bodies, rigid = counts(model)
    put_from_outside(bodies, rigid, model.weight, model.air, drive.pushes, drive.works, y, out)
    # Last, because they take longest to come.
    apply_all_springs(model.several, model.connections, bodies, rigid, model.springs,
                      drive.anchors, drive.moving, drive.works, t, y, out)


@formula
def put_accelerations(model, drive, t, y, forces, out):
    """Write what `accelerations` does; forces: Cells to use, which may be those of out."""
    bodies, rigid = counts(model)
    apply_forces(model, drive, t, y, forces)
    for i in range(bodies):
        v = velocity_at(bodies) + 3 * i
        put_linear_acceleration(out, v, at(forces, v), model.inverse_mass[i])
    accelerate_round(model.several, bodies, rigid, model.round_body, model.inverse_round_inertia,
                     forces, out)
    accelerate_general(model.several, bodies, rigid, model.general_body, model.inertia,
                       model.inverse_inertia, y, forces, out)
    put_powers(drive.works, work_at(bodies, rigid), forces, out)


@formula
def accelerations(model, drive, t, y, out):
    """
    Write linear and angular accelerations and the powers to out, laid out as the state.

    model: Model; drive: Drive; t: [s] since the anchors were as the drive has them; y: state.
    Positions and quaternions of out are not touched.
    """
    put_accelerations(model, drive, t, y, out, out)


@formula
def put_rates(model, drive, t, y, forces, out):
    """Write dy/dt to out, each number once; forces: Cells to use, which may be those of out."""
    bodies, rigid = counts(model)
    # First, because forces take longer to come.
    for i in range(3 * bodies):
        out[i] = y[velocity_at(bodies) + i]
    for i in range(rigid):
        q = quaternion_at(bodies) + 4 * i
        omega = at(y, omega_at(bodies, rigid) + 3 * i)
        put_quaternion(out, q, quaternion_rate_world(quaternion(y, q), omega))
    put_accelerations(model, drive, t, y, forces, out)


@formula
def rates(model, drive, t, y, out):
    """Write dy/dt to out: the whole right-hand side; arguments as for accelerations."""
    put_rates(model, drive, t, y, out, out)
