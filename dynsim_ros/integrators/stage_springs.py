# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
How springs pull at the stages of a collocation method, to first order in the change of the stages.

Springs and dampers are what makes the equations of the stages stiff. As the stiffness of each is
of rank one, there is one unknown for each spring and stage: by how much its pull changes.
"""

from numba import literal_unroll

from .linearly_implicit import damping_of, first_of, spring_count
from .lu_factors import factorise, substitute
from .mass_response import angular_response, fill_responses
from .memory import STAGE_SPRING_SIZE, STAGES
from .radau_tableau import A, A2, NODES
from .stages import integrate_all, stages_of
from ..physics.forces import body_of, group_size, spring_motion
from ..physics.jit import formula
from ..physics.lanes import COUNT, lanes_at, put_lanes, spread
from ..physics.state import omega_at, quaternion_at, velocity_at
from ..physics.vector import dot

# Parts of what is kept of a spring at every stage: u, arm x u at P and at Q, the angular
# accelerations by these, stiffness, damping.
_ARMS, _RESPONSES, _STIFFNESS, _DAMPING = 3, 9, 15, 16


@formula
def keep_vector(memory, place, part, batch, a):
    """Write a vector of Lanes to what is kept of a spring."""
    for k in range(3):
        put_lanes(memory, place + STAGES * (part + k) + COUNT * batch, a[k])


@formula
def gather_group(several, connections, bodies, rigid, general_body, p, q, stiffness, epsilon,
                 damping, anchors, moving, first, spring_bodies, t, y, responses, batch, memory,
                 springs):
    """Write the geometry of the springs of a group at four stages."""
    for s in range(group_size(connections, p)):
        _, u, p_turn, q_turn, _, _ = spring_motion(several, bodies, rigid, p, q, epsilon,
                                                   anchors, moving, t, s, y)
        place = springs + STAGES * STAGE_SPRING_SIZE * (first + s)
        keep_vector(memory, place, 0, batch, u)
        keep_vector(memory, place, _ARMS, batch, p_turn)
        keep_vector(memory, place, _ARMS + 3, batch, q_turn)
        for end in range(2):
            body = spring_bodies[first + s, end]
            if 0 <= body < rigid:
                i = body_of(several, spring_bodies[:, end], first + s)
                turn = p_turn if end == 0 else q_turn
                keep_vector(memory, place, _RESPONSES + 3 * end, batch,
                            angular_response(general_body, responses, i, turn))
        put_lanes(memory, place + STAGES * _STIFFNESS + COUNT * batch, spread(stiffness[s]))
        put_lanes(memory, place + STAGES * _DAMPING + COUNT * batch,
                  spread(damping_of(damping, s)))


@formula
def gather(model, drive, bodies, rigid, groups, table, size, t, h, memory, here, springs, y,
           responses):
    """Write the geometry of all springs at all stages."""
    if groups is not None:
        for batch in range(2):
            for i in range(size):
                y[i] = stages_of(memory, here, i, batch)
            fill_responses(model, spread(0.0), y, responses)
            first = 0
            for group in literal_unroll(groups):
                gather_group(model.several, model.connections, bodies, rigid, model.general_body,
                             group.p, group.q, group.stiffness, group.epsilon, group.damping,
                             drive.anchors, drive.moving, first_of(model.connections, first),
                             model.spring_bodies, t + h * lanes_at(table, NODES + COUNT * batch),
                             y, responses, batch, memory, springs)
                first += group.stiffness.shape[0]


@formula
def kept_vector(memory, place, part, batch):
    """Return a vector of Lanes that is kept of a spring."""
    return (lanes_at(memory, place + STAGES * part + COUNT * batch),
            lanes_at(memory, place + STAGES * (part + 1) + COUNT * batch),
            lanes_at(memory, place + STAGES * (part + 2) + COUNT * batch))


@formula
def kept_at(memory, place, part, stage):
    """Return the same vector at one stage."""
    return (memory[place + STAGES * part + stage], memory[place + STAGES * (part + 1) + stage],
            memory[place + STAGES * (part + 2) + stage])


@formula
def changes(memory, here, new, first, batch):
    """Return the change of three components of the stages."""
    return (stages_of(memory, new, first, batch) - stages_of(memory, here, first, batch),
            stages_of(memory, new, first + 1, batch) - stages_of(memory, here, first + 1, batch),
            stages_of(memory, new, first + 2, batch) - stages_of(memory, here, first + 2, batch))


@formula
def small_rotation(memory, here, new, q, batch):
    """Return the rotation vector by which the orientations change: 2 (new - here) here^-1."""
    w, x, y, z = (stages_of(memory, here, q, batch), stages_of(memory, here, q + 1, batch),
                  stages_of(memory, here, q + 2, batch), stages_of(memory, here, q + 3, batch))
    d = stages_of(memory, new, q, batch) - w
    a, b, c = changes(memory, here, new, q + 1, batch)
    return (2.0 * (w * a - d * x + c * y - b * z), 2.0 * (w * b - d * y + a * z - c * x),
            2.0 * (w * c - d * z + b * x - a * y))


@formula
def stretch(several, bodies, rigid, spring_bodies, j, memory, here, new, place, batch):
    """Return the changes of length and of its rate of spring j between two sets of stages."""
    length, speed = spread(0.0), spread(0.0)
    u = kept_vector(memory, place, 0, batch)
    for end in range(2):
        body = spring_bodies[j, end]
        if body >= 0:
            i = body_of(several, spring_bodies[:, end], j)
            sign = 2.0 * end - 1.0
            length = length + sign * dot(u, changes(memory, here, new, 3 * i, batch))
            speed = speed + sign * dot(u, changes(memory, here, new,
                                                  velocity_at(bodies) + 3 * i, batch))
            if body < rigid:
                turn = kept_vector(memory, place, _ARMS + 3 * end, batch)
                length = length + sign * dot(turn, small_rotation(
                    memory, here, new, quaternion_at(bodies) + 4 * i, batch))
                speed = speed + sign * dot(turn, changes(
                    memory, here, new, omega_at(bodies, rigid) + 3 * i, batch))
    return length, speed


@formula
def fill_pulls(several, bodies, rigid, count, spring_bodies, memory, here, new, springs, pulls):
    """Write how much more the springs pull at the new stages, to first order."""
    for j in range(count):
        place = springs + STAGES * STAGE_SPRING_SIZE * j
        stiffness, damping = memory[place + STAGES * _STIFFNESS], memory[place + STAGES * _DAMPING]
        for batch in range(2):
            length, speed = stretch(several, bodies, rigid, spring_bodies, j, memory, here, new,
                                    place, batch)
            put_lanes(memory, pulls + STAGES * j + COUNT * batch,
                      stiffness * length + damping * speed)


@formula
def fill_matrix(several, bodies, rigid, count, spring_bodies, inverse_mass, table, h, memory,
                springs, matrix):
    """Write the matrix of the equations of the springs' pulls, columns in a row."""
    total_ = STAGES * count
    for j in range(count):
        place = springs + STAGES * STAGE_SPRING_SIZE * j
        stiffness, damping = memory[place + STAGES * _STIFFNESS], memory[place + STAGES * _DAMPING]
        for batch in range(2):
            u = kept_vector(memory, place, 0, batch)
            for k in range(count):
                other = springs + STAGES * STAGE_SPRING_SIZE * k
                for stage in range(STAGES):
                    coupling = spread(0.0)
                    for end in range(2):
                        for far in range(2):
                            body = spring_bodies[j, end]
                            if body >= 0 and body == spring_bodies[k, far]:
                                i = body_of(several, spring_bodies[:, end], j)
                                sign = 1.0 if end == far else -1.0
                                coupling = coupling + (sign * inverse_mass[i]) * dot(
                                    u, kept_at(memory, other, 0, stage))
                                if body < rigid:
                                    coupling = coupling + sign * dot(
                                        kept_vector(memory, place, _ARMS + 3 * end, batch),
                                        kept_at(memory, other, _RESPONSES + 3 * far, stage))
                    strength = (stiffness * h * h * lanes_at(
                        table, A2 + STAGES * stage + COUNT * batch)
                        + damping * h * lanes_at(table, A + STAGES * stage + COUNT * batch))
                    put_lanes(memory, matrix + total_ * (STAGES * k + stage) + STAGES * j
                              + COUNT * batch, strength * coupling)
    for i in range(total_):
        memory[matrix + total_ * i + i] += 1.0


@formula
def add_to_stages(memory, place, batch, change):
    """Add a vector of Lanes to three components of a row of stages."""
    for k in range(3):
        at_ = place + STAGES * k + COUNT * batch
        put_lanes(memory, at_, lanes_at(memory, at_) + change[k])


@formula
def relieve(several, bodies, rigid, count, spring_bodies, mass, memory, springs, pulls, rate):
    """Take what the springs pull less off the accelerations."""
    for j in range(count):
        place = springs + STAGES * STAGE_SPRING_SIZE * j
        for batch in range(2):
            pull = lanes_at(memory, pulls + STAGES * j + COUNT * batch)
            u = kept_vector(memory, place, 0, batch)
            for end in range(2):
                body = spring_bodies[j, end]
                if body >= 0:
                    i = body_of(several, spring_bodies[:, end], j)
                    signed = (1.0 - 2.0 * end) * pull
                    part = signed / mass[i]
                    add_to_stages(memory, rate + STAGES * (velocity_at(bodies) + 3 * i), batch,
                                  (part * u[0], part * u[1], part * u[2]))
                    if body < rigid:
                        turn = kept_vector(memory, place, _RESPONSES + 3 * end, batch)
                        add_to_stages(memory, rate + STAGES * (omega_at(bodies, rigid) + 3 * i),
                                      batch, (signed * turn[0], signed * turn[1],
                                              signed * turn[2]))


@formula
def solver_places(springs, count):
    """Return where the springs' pulls are, the matrix of their equations, and its pivots."""
    pulls = springs + STAGES * STAGE_SPRING_SIZE * count
    matrix = pulls + STAGES * count
    return pulls, matrix, matrix + (STAGES * count) * (STAGES * count)


@formula
def correct(model, drive, bodies, rigid, size, connections, groups, table, t, h, y, memory, here,
            rate, new, springs, cells, responses, is_settled):
    """
    Let the new stages be those with the springs' forces at them, to first order.

    is_settled: whether the matrix is there, from stages next to which these are.
    """
    if groups is not None:
        count = spring_count(connections)
        pulls, matrix, pivots = solver_places(springs, count)
        gather(model, drive, bodies, rigid, groups, table, size, t, h, memory, here, springs,
               cells, responses)
        fill_pulls(model.several, bodies, rigid, count, model.spring_bodies, memory, here, new,
                   springs, pulls)
        if not is_settled:
            fill_matrix(model.several, bodies, rigid, count, model.spring_bodies,
                        model.inverse_mass, table, h, memory, springs, matrix)
            factorise(STAGES * count, memory, matrix, pivots)
        substitute(STAGES * count, memory, matrix, pivots, pulls)
        relieve(model.several, bodies, rigid, count, model.spring_bodies, model.mass, memory,
                springs, pulls, rate)
        integrate_all(bodies, rigid, size, table, h, y, memory, here, rate, new)
