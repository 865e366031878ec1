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

from .air_resistance import relative_velocity
from .energy import power
from .fused import fused
from .jit import formula
from .kinematics import attachment_position, attachment_rate
from .offset import offset_arm
from .spring_damper import (damper_tension, length_and_direction, length_and_inverse_square,
                            spring_tension)
from .state import (ARM, CORRECTION, EXCESS, omega_at, quaternion, quaternion_at, VECTOR,
                    velocity_at, work_at)
from .vector import accumulate_scaled, add, at, cross, dot, scale, subtract


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
        return offset_arm(quaternion(y, quaternion_at(bodies) + 4 * i), offset, s)
    return at(y, ARM)


@formula
def body_of(several, index, s):
    """Return the body that spring s is at; a single body is known when compiled."""
    if several is not None:
        return index[s]
    return 0


@formula
def end_place(several, bodies, anchor, particle, body, offset, s, anchors, moving, t, y):
    """Return position and arm (points: zero) of one end of spring s."""
    arm = (0.0, 0.0, 0.0)
    if anchor is not None:
        position, _ = anchor_motion(anchors, moving, anchor[s], t)
    if particle is not None:
        position, _ = particle_motion(bodies, body_of(several, particle, s), y)
    if body is not None:
        centre, _ = particle_motion(bodies, body_of(several, body, s), y)
        arm = arm_of(bodies, body_of(several, body, s), offset, s, y)
        position = attachment_position(centre, arm)
    return position, arm


@formula
def anchor_rate(anchors, moving, i, u):
    """Return the velocity of anchor i along u [m/s]."""
    if moving is not None:
        return dot(at(anchors[i], 3), u)
    return 0.0


@formula
def end_rate(several, bodies, rigid, anchor, particle, body, s, anchors, moving, u, turn, y):
    """Return the velocity of one end of spring s along u, of any length; turn: its arm x u."""
    if anchor is not None:
        return anchor_rate(anchors, moving, anchor[s], u)
    if particle is not None:
        return dot(at(y, velocity_at(bodies) + 3 * body_of(several, particle, s)), u)
    if body is not None:
        i = body_of(several, body, s)
        return attachment_rate(at(y, velocity_at(bodies) + 3 * i),
                               at(y, omega_at(bodies, rigid) + 3 * i), u, turn)
    return 0.0


@formula
def spring_ends(several, bodies, p, q, anchors, moving, t, s, y):
    """Return the vector from P to Q of spring s of a group and the arms of P and Q: (3,) [m]."""
    r_p, p_arm = end_place(several, bodies, p.anchor, p.particle, p.body, p.offset, s, anchors,
                           moving, t, y)
    r_q, q_arm = end_place(several, bodies, q.anchor, q.particle, q.body, q.offset, s, anchors,
                           moving, t, y)
    return subtract(r_q, r_p), p_arm, q_arm


@formula
def end_rates(several, bodies, rigid, p, q, s, anchors, moving, u, p_turn, q_turn, y):
    """Return the velocities of P and Q of spring s along u, a vector of any length."""
    p_rate = end_rate(several, bodies, rigid, p.anchor, p.particle, p.body, s, anchors, moving, u,
                      p_turn, y)
    q_rate = end_rate(several, bodies, rigid, q.anchor, q.particle, q.body, s, anchors, moving, u,
                      q_turn, y)
    return p_rate, q_rate


@formula
def spring_motion(several, bodies, rigid, p, q, epsilon, anchors, moving, t, s, y):
    """
    Return what linearly implicit methods need of spring s of a group.

    That is L, u, arm x u at P and at Q (zero at points), and the velocities of P and Q along u. A
    tension T along u acts on the body at Q with the force T u and the moment T (arm x u).
    """
    r, p_arm, q_arm = spring_ends(several, bodies, p, q, anchors, moving, t, s, y)
    length, u = length_and_direction(r, epsilon[s])
    p_turn, q_turn = cross(p_arm, u), cross(q_arm, u)
    p_rate, q_rate = end_rates(several, bodies, rigid, p, q, s, anchors, moving, u, p_turn, q_turn,
                               y)
    return length, u, p_turn, q_turn, p_rate, q_rate


@formula
def pull(several, bodies, rigid, particle, body, s, factor, r, turn, out):
    """Add the force factor r at an end of spring s, and its moment, to what acts there."""
    if particle is not None:
        accumulate_scaled(out, velocity_at(bodies) + 3 * body_of(several, particle, s), factor, r)
    if body is not None:
        i = body_of(several, body, s)
        accumulate_scaled(out, velocity_at(bodies) + 3 * i, factor, r)
        accumulate_scaled(out, omega_at(bodies, rigid) + 3 * i, factor, turn)


@formula
def anchor_speed(p_anchor, q_anchor, p_rate, q_rate):
    """Return the velocity with which an anchor pulls along the force on Q; 0 without one."""
    if p_anchor is not None:
        return p_rate
    if q_anchor is not None:
        return -q_rate
    return 0.0


@formula
def count_anchor_work(several, bodies, rigid, p, q, s, anchors, moving, r, p_turn, q_turn, works,
                      work, factor, y, out):
    """Add the power of moving anchors, if works are counted."""
    if works is not None:
        if moving is not None:
            p_rate, q_rate = end_rates(several, bodies, rigid, p, q, s, anchors, moving, r, p_turn,
                                       q_turn, y)
            out[work + 2] = out[work + 2] + factor * anchor_speed(p.anchor, q.anchor, p_rate,
                                                                  q_rate)


@formula
def count_damper_work(works, work, damping, rate, inverse_square, out):
    """Add the power of a damper, -b (dL/dt)^2, if works are counted; rate: L dL/dt [m^2/s]."""
    if works is not None:
        out[work] = out[work] - damping * rate * rate * inverse_square


@formula
def with_damper(several, bodies, rigid, p, q, damping, s, anchors, moving, r, p_turn, q_turn,
                inverse_square, works, work, per_extension, extension, y, out):
    """Return L times the tension of a spring and its damper; count the damper's work."""
    if damping is not None:
        p_rate, q_rate = end_rates(several, bodies, rigid, p, q, s, anchors, moving, r, p_turn,
                                   q_turn, y)
        rate = q_rate - p_rate
        count_damper_work(works, work, damping[s], rate, inverse_square, out)
        return fused(per_extension, extension, damper_tension(damping[s], rate))
    return per_extension * extension


@formula
def group_size(connections, p):
    """Return how many springs a group has; known when compiled where there is only one."""
    if connections is not None:
        return ends_size(p.anchor, p.particle, p.body)
    return 1


@formula
def ends_size(anchor, particle, body):
    """Return how many ends there are; as in SpringEnds."""
    if anchor is not None:
        return len(anchor)
    if particle is not None:
        return len(particle)
    if body is not None:
        return len(body)
    return 0


@formula
def kept_reach(is_kept, reach_at, r, y):
    """Return the vector to Q from P: the one that the state has, or r."""
    if is_kept is not None:
        return at(y, reach_at + VECTOR)
    return r


@formula
def spring_extension(is_kept, reach_at, length, natural_length, y):
    """Return L - L_n [m]; where the state has what it takes, without the rounding of L."""
    extension = length - natural_length
    if is_kept is not None:
        rounding = fused(-extension, length + natural_length, y[reach_at + EXCESS])
        extension = fused(y[reach_at + CORRECTION], rounding, extension)
    return extension


@formula
def apply_springs(several, connections, bodies, rigid, p, q, stiffness, natural_length, epsilon,
                  damping, reach_at, is_kept, anchors, moving, works, t, y, out):
    """
    Add forces and moments of one SpringGroup; t: [s] since the anchors were as given.

    With r = L u the force on Q is (-k (L - L_n) L - b v . r) / L^2 r: the root and the division do
    not wait for each other, and only one product waits for both.
    """
    work = work_at(bodies, rigid)
    for s in range(group_size(connections, p)):
        r, p_arm, q_arm = spring_ends(several, bodies, p, q, anchors, moving, t, s, y)
        r = kept_reach(is_kept, reach_at, r, y)
        length, inverse_square = length_and_inverse_square(r, epsilon[s])
        p_turn, q_turn = cross(p_arm, r), cross(q_arm, r)
        extension = spring_extension(is_kept, reach_at, length, natural_length[s], y)
        # Of L times the tension: this product does not wait for the difference.
        per_extension = spring_tension(stiffness[s], length)
        factor = inverse_square * with_damper(
            several, bodies, rigid, p, q, damping, s, anchors, moving, r, p_turn, q_turn,
            inverse_square, works, work, per_extension, extension, y, out)
        pull(several, bodies, rigid, q.particle, q.body, s, factor, r, q_turn, out)
        pull(several, bodies, rigid, p.particle, p.body, s, -factor, r, p_turn, out)
        count_anchor_work(several, bodies, rigid, p, q, s, anchors, moving, r, p_turn, q_turn,
                          works, work, factor, y, out)


@formula
def begin_works(works, work, out):
    """Let the powers begin, if works are counted."""
    if works is not None:
        for i in range(work, work + 4):
            out[i] = -0.0


@formula
def put_powers(works, work, forces, out):
    """Write the powers, if works are counted; forces: where they are."""
    if works is not None:
        for i in range(work, work + 4):
            out[i] = forces[i]


@formula
def with_push(pushes, i, works, work, y, force, out):
    """Return a force or moment (3,) with the commanded one at i, and count its power."""
    if pushes is not None:
        push = at(pushes, i)
        count_push_work(works, work, push, at(y, i), out)
        return add(force, push)
    return force


@formula
def count_push_work(works, work, push, velocity, out):
    """Add the power of a commanded force or torque, if works are counted."""
    if works is not None:
        for k in range(3):
            out[work + 3] = out[work + 3] + push[k] * velocity[k]


@formula
def with_weight(weight, i, force):
    """Return a force (3,) with the weight of body i."""
    if weight is not None:
        return add(force, at(weight[i], 0))
    return force


@formula
def with_linear_drag(linear_drag, air_velocity, v, works, work, y, force, out):
    """Return a force (3,) with the air's on a body whose velocity is at v; count its power."""
    if linear_drag is not None:
        return with_drag(linear_drag, air_velocity, v, works, work, y, force, out)
    return force


@formula
def with_rotational_drag(rotational_drag, air_angular_velocity, w, works, work, y, moment, out):
    """Return a moment (3,) with the air's likewise; w: where the angular velocity is."""
    if rotational_drag is not None:
        return with_drag(rotational_drag, air_angular_velocity, w, works, work, y, moment, out)
    return moment


@formula
def with_drag(drag, air, i, works, work, y, force, out):
    """Return a force or moment with the air's; air: its (angular) velocity, None if still."""
    velocity = at(y, i)
    relative = relative_velocity(velocity, air)
    count_air_work(works, work, drag, relative, velocity, out)
    return (fused(-drag, relative[0], force[0]), fused(-drag, relative[1], force[1]),
            fused(-drag, relative[2], force[2]))


@formula
def count_air_work(works, work, drag, relative, velocity, out):
    """Add the power of the air, if works are counted."""
    if works is not None:
        out[work + 1] = out[work + 1] + power(scale(-drag, relative), velocity)
