# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Forces and moments by what exerts them, as they are published: in the words of the sheet.

The equations of motion add up the same forces with fewer operations: see forces.
"""

from numba import literal_unroll

from .air_resistance import air_force, air_torque
from .equations_of_motion import moment_of_force
from .forces import anchor_motion, arm_of, body_of, group_size, particle_motion
from .jit import formula, kernel
from .kinematics import attachment_position, attachment_velocity
from .spring_damper import damper_force, length_and_direction, length_rate, spring_force
from .state import counts, omega_at, quaternion_at, velocity_at, work_at
from .vector import accumulate, at, scale, subtract


@formula
def point_motion(bodies, rigid, i, offset, s, y):
    """Return position and velocity in world of an attachment point of body i, and its arm."""
    position, velocity = particle_motion(bodies, i, y)
    omega = at(y, omega_at(bodies, rigid) + 3 * i)
    arm = arm_of(bodies, i, offset, s, y)
    return attachment_position(position, arm), attachment_velocity(velocity, omega, arm), arm


@formula
def end_motion(several, bodies, rigid, anchor, particle, body, offset, s, anchors, t, y):
    """Return position, velocity and arm (points: zero) of one end of spring s."""
    arm = (0.0, 0.0, 0.0)
    if anchor is not None:
        position, velocity = anchor_motion(anchors, True, anchor[s], t)
    if particle is not None:
        position, velocity = particle_motion(bodies, body_of(several, particle, s), y)
    if body is not None:
        position, velocity, arm = point_motion(bodies, rigid, body_of(several, body, s),
                                               offset, s, y)
    return position, velocity, arm


@formula
def sheet_motion(several, bodies, rigid, p, q, epsilon, anchors, t, s, y):
    """Return L, u, dL/dt and both arms of spring s of a group."""
    r_p, v_p, p_arm = end_motion(several, bodies, rigid, p.anchor, p.particle, p.body, p.offset,
                                 s, anchors, t, y)
    r_q, v_q, q_arm = end_motion(several, bodies, rigid, q.anchor, q.particle, q.body, q.offset,
                                 s, anchors, t, y)
    length, u = length_and_direction(subtract(r_q, r_p), epsilon[s])
    return length, u, length_rate(subtract(v_q, v_p), u), p_arm, q_arm


@formula
def apply_at_end(several, bodies, rigid, particle, body, s, arm, force, out):
    """Add a force at an end of spring s, and its moment, to what acts on the body there."""
    if particle is not None:
        accumulate(out, velocity_at(bodies) + 3 * body_of(several, particle, s), force)
    if body is not None:
        i = body_of(several, body, s)
        accumulate(out, velocity_at(bodies) + 3 * i, force)
        accumulate(out, omega_at(bodies, rigid) + 3 * i, moment_of_force(arm, force))


@formula
def apply_at_ends(several, bodies, rigid, p, q, s, p_arm, q_arm, force, out):
    """Add a spring's force on Q to what Q is on and its opposite to what P is on."""
    apply_at_end(several, bodies, rigid, q.particle, q.body, s, q_arm, force, out)
    apply_at_end(several, bodies, rigid, p.particle, p.body, s, p_arm, scale(-1.0, force), out)


@formula
def apply_spring_forces(several, connections, bodies, rigid, p, q, stiffness, natural_length,
                        epsilon, anchors, t, y, out):
    """Add forces and moments of the springs of a group without their dampers, as on the sheet."""
    for s in range(group_size(connections, p)):
        length, u, _, p_arm, q_arm = sheet_motion(several, bodies, rigid, p, q, epsilon, anchors,
                                                  t, s, y)
        force = spring_force(stiffness[s], length, natural_length[s], u)
        apply_at_ends(several, bodies, rigid, p, q, s, p_arm, q_arm, force, out)


@formula
def apply_damper_forces(several, connections, bodies, rigid, p, q, epsilon, damping, anchors, t, y,
                        out):
    """Add forces and moments of the dampers alone of one SpringGroup, as on the sheet."""
    if damping is not None:
        for s in range(group_size(connections, p)):
            _, u, rate, p_arm, q_arm = sheet_motion(several, bodies, rigid, p, q, epsilon, anchors,
                                                    t, s, y)
            force = damper_force(damping[s], rate, u)
            apply_at_ends(several, bodies, rigid, p, q, s, p_arm, q_arm, force, out)


@formula
def apply_all_springs(several, connections, bodies, rigid, springs, anchors, t, y, out):
    """Add forces and moments of all springs, without their dampers."""
    if springs is not None:
        for group in literal_unroll(springs):
            apply_spring_forces(several, connections, bodies, rigid, group.p, group.q,
                                group.stiffness, group.natural_length, group.epsilon, anchors, t,
                                y, out)


@formula
def apply_all_dampers(several, connections, bodies, rigid, springs, anchors, t, y, out):
    """Add forces and moments of all dampers."""
    if springs is not None:
        for group in literal_unroll(springs):
            apply_damper_forces(several, connections, bodies, rigid, group.p, group.q,
                                group.epsilon, group.damping, anchors, t, y, out)


@formula
def apply_drags(bodies, rigid, linear_drag, rotational_drag, velocity, angular_velocity, y, out):
    """Add the air's forces and torques of those of the two resistances that exist."""
    if linear_drag is not None:
        for i in range(velocity_at(bodies), quaternion_at(bodies), 3):
            accumulate(out, i, air_force(linear_drag, at(y, i), velocity))
    if rotational_drag is not None:
        for i in range(omega_at(bodies, rigid), work_at(bodies, rigid), 3):
            accumulate(out, i, air_torque(rotational_drag, at(y, i), angular_velocity))


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


@kernel
def wrenches(model, anchors, t, y, out):
    """
    Write what each kind of force does to each body; each row of out is laid out as the state.

    anchors: (n, 6) as in Drive; out: (4, state_size), zero on entry; rows: spring, damper, air,
    gravity.
    """
    bodies, rigid = counts(model)
    apply_all_springs(model.several, model.connections, bodies, rigid, model.springs, anchors, t,
                      y, out[0])
    apply_all_dampers(model.several, model.connections, bodies, rigid, model.springs, anchors, t,
                      y, out[1])
    apply_air(bodies, rigid, model.air, y, out[2])
    apply_gravity(bodies, model.weight, out[3])
