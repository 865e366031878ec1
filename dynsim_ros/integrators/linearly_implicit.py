# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
One substep of the linearly implicit Euler method for springs, dampers and drag.

The stiff part of the Jacobian is known: a spring pulls along g = (u, arm x u), so that its
stiffness is -k g g^T and its damper's -b g g^T, of rank one. With p the pull of each spring,

    v_new = v + h (a + M^-1 sum g p),    p = -k (L - L_n) - (h k + b) g . v_new

is a linear system with one unknown for each spring, whatever the number of bodies; a is the
acceleration by all else, in which drag is implicit, too. Positions follow with v_new. L-stable:
a spring that is too stiff for h comes to rest. States are Lanes: h differs from lane to lane.

Hairer, Wanner, Solving Ordinary Differential Equations II, IV.9 (extrapolation of it); the
low-rank solution is Woodbury's.
"""

from numba import literal_unroll

from .mass_response import angular_response, fill_responses, RESPONSE_SIZE
from .memory import spring_place, SPRING_SIZE
from ..physics.cells import lane_cells
from ..physics.forces import anchor_speed, body_of, group_size, spring_motion
from ..physics.jit import formula
from ..physics.lanes import COUNT, spread
from ..physics.motion import chosen, matrix_at, member, put_from_outside
from ..physics.rotation import quaternion_rate_world, rotation_matrix
from ..physics.spring_damper import spring_tension
from ..physics.state import (counts, omega_at, put_quaternion, quaternion,
                             quaternion_at, velocity_at, work_at)
from ..physics.vector import (accumulate, add, at, cross, dot, put, scale, transform,
                              transform_back)

# Where the parts of what is kept of a spring lie: u, arm x u at P and at Q, the angular
# accelerations by these, h k + b, the pull that the spring would have at the given velocity;
# where works are counted, also -k (L - L_n), b, and the speed at which anchors lengthen it.
ARMS, RESPONSES, STRENGTH, PULL = 3, 9, 15, 16
SPRING_PULL, DAMPING, ANCHOR_SPEED = 17, 18, 19


@formula
def spring_count(connections):
    """Return the number of springs; known when compiled where it is one."""
    if connections is not None:
        return connections
    return 1


@formula
def damping_of(damping, s):
    """Return the damping of spring s, 0 where its group has none."""
    if damping is not None:
        return damping[s]
    return 0.0


@formula
def gather_group(several, connections, bodies, rigid, p, q, stiffness, natural_length, epsilon,
                 damping, anchors, moving, works, first, t, h, y, springs):
    """Write geometry and pull of the springs of a group to `springs`, from number `first` on."""
    for s in range(group_size(connections, p)):
        length, u, p_turn, q_turn, p_rate, q_rate = spring_motion(
            several, bodies, rigid, p, q, epsilon, anchors, moving, t, s, y)
        j = SPRING_SIZE * (first + s)
        strength = h * stiffness[s] + damping_of(damping, s)
        put(springs, j, u)
        put(springs, j + ARMS, p_turn)
        put(springs, j + ARMS + 3, q_turn)
        springs[j + STRENGTH] = strength
        spring_pull = spring_tension(stiffness[s], length - natural_length[s])
        springs[j + PULL] = spring_pull - strength * (q_rate - p_rate)
        keep_for_works(works, p.anchor, q.anchor, spring_pull, damping_of(damping, s), p_rate,
                       q_rate, u, j, springs)


@formula
def keep_for_works(works, p_anchor, q_anchor, spring_pull, damping, p_rate, q_rate, u, j, springs):
    """Keep what the works of a spring need, if they are counted."""
    if works is not None:
        springs[j + SPRING_PULL] = spring_pull
        springs[j + DAMPING] = spread(damping)
        springs[j + ANCHOR_SPEED] = u[0] * 0.0 + anchor_speed(p_anchor, q_anchor, p_rate, q_rate)


@formula
def count_spring_works(works, works_at, connections, h, p, springs, y):
    """Add the works of dampers and anchors in a substep, if they are counted; p: pulls."""
    if works is not None:
        for j in range(spring_count(connections)):
            place = SPRING_SIZE * j
            rate = (springs[place + SPRING_PULL] - p[j]) / springs[place + STRENGTH]
            y[works_at] = y[works_at] - h * (springs[place + DAMPING] * rate * rate)
            y[works_at + 2] = y[works_at + 2] + h * (p[j] * springs[place + ANCHOR_SPEED])


@formula
def count_other_works(works, bodies, rigid, air, pushes, h, y, f):
    """Add the works of the air and of pushes in a substep, if they are counted."""
    if works is not None:
        work = work_at(bodies, rigid)
        put_from_outside(bodies, rigid, None, air, pushes, works, y, f)
        y[work + 1] = y[work + 1] + h * f[work + 1]
        y[work + 3] = y[work + 3] + h * f[work + 3]


@formula
def gather(several, bodies, rigid, connections, groups, anchors, moving, works, t, h, y,
           springs):
    """Write geometry and pull of all springs to `springs`."""
    first = 0
    for group in literal_unroll(groups):
        gather_group(several, connections, bodies, rigid, group.p, group.q, group.stiffness,
                     group.natural_length, group.epsilon, group.damping, anchors, moving, works,
                     first_of(connections, first), t, h, y, springs)
        first += group.stiffness.shape[0]


@formula
def first_of(connections, first):
    """Return the number of a spring; known when compiled where there is one."""
    if connections is not None:
        return first
    return 0


@formula
def free_accelerations(model, drive, responses, t, y, f):
    """Write the accelerations by all but springs and dampers to f."""
    bodies, rigid = counts(model)
    put_from_outside(bodies, rigid, model.weight, model.air, drive.pushes, None, y, f)
    turn_with(model.several, bodies, rigid, model.general_body, model.inertia, y, f)
    for i in range(bodies):
        v = velocity_at(bodies) + 3 * i
        put(f, v, scale(responses[RESPONSE_SIZE * i], at(f, v)))
    for i in range(rigid):
        w = omega_at(bodies, rigid) + 3 * i
        put(f, w, angular_response(model.general_body, responses, i, at(f, w)))


@formula
def turn_with(several, bodies, rigid, general_body, inertia, y, f):
    """Add the gyroscopic moments -omega x (I omega), in world."""
    if general_body is not None:
        for k in range(chosen(several, general_body)):
            i = member(several, general_body, k)
            w = omega_at(bodies, rigid) + 3 * i
            rotation = rotation_matrix(quaternion(y, quaternion_at(bodies) + 4 * i))
            omega = transform_back(rotation, at(y, w))
            gyroscopic = cross(omega, transform(matrix_at(inertia, k), omega))
            accumulate(f, w, scale(-1.0, transform(rotation, gyroscopic)))


@formula
def along(several, bodies, rigid, spring_bodies, j, springs, f):
    """Return the acceleration of the length of spring j by accelerations f, but for rotation."""
    place = SPRING_SIZE * j
    u = at(springs, place)
    sum_ = spread(0.0)
    for end in range(2):
        if spring_bodies[j, end] >= 0:
            i = body_of(several, spring_bodies[:, end], j)
            part = dot(u, at(f, velocity_at(bodies) + 3 * i))
            if i < rigid:
                part = part + dot(at(springs, place + ARMS + 3 * end),
                                  at(f, omega_at(bodies, rigid) + 3 * i))
            sum_ = sum_ + part if end == 1 else sum_ - part
    return sum_


@formula
def respond(several, rigid, general_body, spring_bodies, responses, j, springs):
    """Write the angular accelerations that a unit pull of spring j gives to its ends."""
    place = SPRING_SIZE * j
    for end in range(2):
        put(springs, place + RESPONSES + 3 * end, (spread(0.0), spread(0.0), spread(0.0)))
        if 0 <= spring_bodies[j, end] < rigid:
            i = body_of(several, spring_bodies[:, end], j)
            put(springs, place + RESPONSES + 3 * end, angular_response(
                general_body, responses, i, at(springs, place + ARMS + 3 * end)))


@formula
def coupling(several, spring_bodies, responses, j, k, springs):
    """Return the acceleration of the length of spring j that a unit pull of spring k gives."""
    sum_ = spread(0.0)
    alike = dot(at(springs, SPRING_SIZE * j), at(springs, SPRING_SIZE * k))
    for end in range(2):
        for other in range(2):
            if spring_bodies[j, end] >= 0 and spring_bodies[j, end] == spring_bodies[k, other]:
                i = body_of(several, spring_bodies[:, end], j)
                part = alike * responses[RESPONSE_SIZE * i] + dot(
                    at(springs, SPRING_SIZE * j + ARMS + 3 * end),
                    at(springs, SPRING_SIZE * k + RESPONSES + 3 * other))
                sum_ = sum_ + part if end == other else sum_ - part
    return sum_


@formula
def solve(count, matrix, p):
    """
    Replace p by the solution of matrix x = p; the matrix is overwritten.

    Elimination without pivots: the matrix is 1 + C G with C diagonal, not negative, and G
    symmetric, positive semidefinite, so that its pivots are at least 1.
    """
    for k in range(count):
        for i in range(k + 1, count):
            factor = matrix[count * i + k] / matrix[count * k + k]
            for j in range(k + 1, count):
                matrix[count * i + j] = matrix[count * i + j] - factor * matrix[count * k + j]
            p[i] = p[i] - factor * p[k]
    for k in range(count - 1, -1, -1):
        for j in range(k + 1, count):
            p[k] = p[k] - matrix[count * k + j] * p[j]
        p[k] = p[k] / matrix[count * k + k]


@formula
def pull(several, bodies, rigid, spring_bodies, responses, j, p, springs, f):
    """Add the accelerations by spring j, which pulls with p, to f."""
    place = SPRING_SIZE * j
    for end in range(2):
        if spring_bodies[j, end] >= 0:
            i = body_of(several, spring_bodies[:, end], j)
            signed = p if end == 1 else -p
            accumulate(f, velocity_at(bodies) + 3 * i,
                       scale(signed * responses[RESPONSE_SIZE * i], at(springs, place)))
            if i < rigid:
                accumulate(f, omega_at(bodies, rigid) + 3 * i,
                           scale(signed, at(springs, place + RESPONSES + 3 * end)))


@formula
def add_springs(several, bodies, rigid, connections, groups, spring_bodies, general_body, anchors,
                moving, works, responses, t, h, y, memory, f):
    """Add the accelerations by all springs and dampers to f, and their works to y."""
    count = spring_count(connections)
    size = 6 * bodies + 7 * rigid + 4
    place = spring_place(size)
    springs = lane_cells(connections, memory, place, SPRING_SIZE * count)
    p = lane_cells(connections, memory, place + COUNT * SPRING_SIZE * count, count)
    matrix = lane_cells(connections, memory, place + COUNT * (SPRING_SIZE + 1) * count,
                        count * count)
    if groups is not None:
        gather(several, bodies, rigid, connections, groups, anchors, moving, works, t, h, y,
               springs)
        for j in range(count):
            respond(several, rigid, general_body, spring_bodies, responses, j, springs)
        for j in range(count):
            strength = h * springs[SPRING_SIZE * j + STRENGTH]
            p[j] = springs[SPRING_SIZE * j + PULL] - strength * along(
                several, bodies, rigid, spring_bodies, j, springs, f)
            for k in range(count):
                matrix[count * j + k] = strength * coupling(several, spring_bodies, responses, j,
                                                            k, springs)
            matrix[count * j + j] = matrix[count * j + j] + 1.0
        solve(count, matrix, p)
        for j in range(count):
            pull(several, bodies, rigid, spring_bodies, responses, j, p[j], springs, f)
        count_spring_works(works, work_at(bodies, rigid), connections, h, p, springs, y)


@formula
def linearly_implicit_substep(model, drive, t, h, memory, y, f, responses):
    """Replace the states y at t by those at t + h; t, h: Lanes; f, responses: Cells to use."""
    bodies, rigid = counts(model)
    fill_responses(model, h, y, responses)
    free_accelerations(model, drive, responses, t, y, f)
    add_springs(model.several, bodies, rigid, model.connections, model.springs,
                model.spring_bodies, model.general_body, drive.anchors, drive.moving, drive.works,
                responses, t, h, y, memory, f)
    for i in range(bodies):
        v = velocity_at(bodies) + 3 * i
        put(y, v, add(at(y, v), scale(h, at(f, v))))
        put(y, 3 * i, add(at(y, 3 * i), scale(h, at(y, v))))
    for i in range(rigid):
        w = omega_at(bodies, rigid) + 3 * i
        put(y, w, add(at(y, w), scale(h, at(f, w))))
        place = quaternion_at(bodies) + 4 * i
        q = quaternion(y, place)
        rate = quaternion_rate_world(q, at(y, w))
        put_quaternion(y, place, (q[0] + h * rate[0], q[1] + h * rate[1], q[2] + h * rate[2],
                                  q[3] + h * rate[3]))
    count_other_works(drive.works, bodies, rigid, model.air, drive.pushes, h, y, f)
