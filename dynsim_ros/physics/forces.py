# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The loops over springs and bodies that add up forces and moments.

Forces lie in memory that is laid out as the state: the force on a body where its velocity is,
the moment about its centre of mass where its angular velocity is, and the power of dampers, air
and anchors where their work is. Numbers may be Lanes.

The branches on None are decided when a function is compiled: a kind of end that a group of
springs does not have is not in its code. Each is on an argument, as the compiler asks for.
"""

from .air_resistance import air_force, air_torque
from .energy import power
from .equations_of_motion import moment_of_force
from .jit import formula
from .kinematics import attachment_arm, attachment_position, attachment_velocity
from .spring_damper import damper_force, length_and_direction, length_rate, spring_force
from .state import ARM, omega_at, quaternion, quaternion_at, velocity_at, work_at
from .vector import accumulate, add, at, scale, subtract


@formula
def anchor_motion(anchors, moving, i, t):
    """Return position and velocity of anchor i at time t; anchors and moving as in Drive."""
    position = at(anchors[i], 0)
    velocity = (0.0, 0.0, 0.0)
    if moving is not None:
        velocity = at(anchors[i], 3)
        position = add(position, scale(t, velocity))
    return position, velocity


@formula
def particle_motion(bodies, i, y):
    """Return position and velocity in world of the centre of mass of body i."""
    return at(y, 3 * i), at(y, velocity_at(bodies) + 3 * i)


@formula
def arm_of(bodies, i, offset, s, y):
    """Return the arm of the attachment point of spring s on body i, in world: (3,) [m]."""
    if offset is not None:
        return attachment_arm(quaternion(y, quaternion_at(bodies) + 4 * i), at(offset[s], 0))
    return at(y, ARM)


@formula
def point_motion(bodies, rigid, i, offset, s, y):
    """Return position and velocity in world of an attachment point of body i, and its arm."""
    position, velocity = particle_motion(bodies, i, y)
    omega = at(y, omega_at(bodies, rigid) + 3 * i)
    arm = arm_of(bodies, i, offset, s, y)
    return attachment_position(position, arm), attachment_velocity(velocity, omega, arm), arm


@formula
def body_of(several, index, s):
    """Return the body that spring s is at; a single body is known when compiled."""
    if several is not None:
        return index[s]
    return 0


@formula
def end_motion(several, bodies, rigid, anchor, particle, body, offset, s, anchors, moving, t, y):
    """Return position, velocity and arm (points: zero) of one end of spring s."""
    arm = (0.0, 0.0, 0.0)
    if anchor is not None:
        position, velocity = anchor_motion(anchors, moving, anchor[s], t)
    if particle is not None:
        position, velocity = particle_motion(bodies, body_of(several, particle, s), y)
    if body is not None:
        position, velocity, arm = point_motion(bodies, rigid, body_of(several, body, s),
                                               offset, s, y)
    return position, velocity, arm


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
def anchor_power(p_anchor, q_anchor, v_p, v_q, force):
    """Return the power of the anchors that hold a spring whose force on Q is given [W]."""
    total = 0.0
    if p_anchor is not None:
        return power(force, v_p)
    if q_anchor is not None:
        return -power(force, v_q)
    return total


@formula
def count_anchor_work(works, moving, work, p_anchor, q_anchor, v_p, v_q, force, out):
    """Add the power of moving anchors, if works are counted."""
    if works is not None:
        if moving is not None:
            out[work + 2] = out[work + 2] + anchor_power(p_anchor, q_anchor, v_p, v_q, force)


@formula
def count_damper_work(works, work, damping, rate, out):
    """Add the power of a damper, if works are counted."""
    if works is not None:
        out[work] = out[work] - damping * rate * rate


@formula
def spring_motion(several, bodies, rigid, p, q, epsilon, anchors, moving, t, s, y):
    """Return L, u, both ends' velocities and both arms of spring s of a group."""
    r_p, v_p, p_arm = end_motion(several, bodies, rigid, p.anchor, p.particle, p.body, p.offset,
                                 s, anchors, moving, t, y)
    r_q, v_q, q_arm = end_motion(several, bodies, rigid, q.anchor, q.particle, q.body, q.offset,
                                 s, anchors, moving, t, y)
    length, u = length_and_direction(subtract(r_q, r_p), epsilon[s])
    return length, u, v_p, v_q, p_arm, q_arm


@formula
def damper_part(damping, works, work, s, v_p, v_q, u, force, out):
    """Return a spring's force with its damper's added; count the damper's work."""
    if damping is not None:
        rate = length_rate(subtract(v_q, v_p), u)
        count_damper_work(works, work, damping[s], rate, out)
        force = add(force, damper_force(damping[s], rate, u))
    return force


@formula
def apply_springs(several, bodies, rigid, p, q, stiffness, natural_length, epsilon, damping,
                  anchors, moving, works, t, y, out):
    """Add forces and moments of one SpringGroup; t: [s] since the anchors were as given."""
    work = work_at(bodies, rigid)
    for s in range(stiffness.shape[0]):
        length, u, v_p, v_q, p_arm, q_arm = spring_motion(
            several, bodies, rigid, p, q, epsilon, anchors, moving, t, s, y)
        force = spring_force(stiffness[s], length, natural_length[s], u)
        force = damper_part(damping, works, work, s, v_p, v_q, u, force, out)
        apply_at_ends(several, bodies, rigid, p, q, s, p_arm, q_arm, force, out)
        count_anchor_work(works, moving, work, p.anchor, q.anchor, v_p, v_q, force, out)


@formula
def apply_dampers(several, bodies, rigid, p, q, epsilon, damping, anchors, t, y, out):
    """Add forces and moments of the dampers alone of one SpringGroup."""
    if damping is not None:
        for s in range(damping.shape[0]):
            _, u, v_p, v_q, p_arm, q_arm = spring_motion(
                several, bodies, rigid, p, q, epsilon, anchors, True, t, s, y)
            force = damper_force(damping[s], length_rate(subtract(v_q, v_p), u), u)
            apply_at_ends(several, bodies, rigid, p, q, s, p_arm, q_arm, force, out)


@formula
def count_air_work(works, work, force, velocity, out):
    """Add the power of the air, if works are counted."""
    if works is not None:
        out[work + 1] = out[work + 1] + power(force, velocity)


@formula
def apply_linear_drag(bodies, rigid, linear_drag, air_velocity, works, y, out):
    """Add the air's force on every body."""
    work = work_at(bodies, rigid)
    for i in range(velocity_at(bodies), quaternion_at(bodies), 3):
        velocity = at(y, i)
        force = air_force(linear_drag, velocity, air_velocity)
        accumulate(out, i, force)
        count_air_work(works, work, force, velocity, out)


@formula
def apply_rotational_drag(bodies, rigid, rotational_drag, air_angular_velocity, works, y, out):
    """Add the air's torque on every rigid body."""
    work = work_at(bodies, rigid)
    for i in range(omega_at(bodies, rigid), work, 3):
        omega = at(y, i)
        torque = air_torque(rotational_drag, omega, air_angular_velocity)
        accumulate(out, i, torque)
        count_air_work(works, work, torque, omega, out)
