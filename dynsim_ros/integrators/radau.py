# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
One step of the Radau IIA method with eight stages, order 15, its stages side by side in Lanes.

For stiff springs where the slow motion has to be exact: L-stable, and of order 8 at least whatever
the stiffness. The stages solve a system of equations; it is iterated with the forces as they are,
but for the springs and dampers, whose stiffness, of rank one for each spring, is in the
iteration's matrix: one unknown for each spring and stage. The stages stay in the memory: they are
the dense output.

Hairer, Wanner, Solving Ordinary Differential Equations II, IV.5, IV.8, VII.4.
"""

import math

from numba import literal_unroll

from .linearly_implicit import damping_of, first_of, spring_count
from .mass_response import angular_response, fill_responses
from .memory import DENSE_SIZE, lane_row, stage_place, STAGE_ROWS, STAGE_SPRING_SIZE, STAGES
from .radau_tableau import A, A2, CAUTION, ERROR, NODES, SLOPE
from ..physics.forces import body_of, group_size, spring_motion
from ..physics.jit import formula
from ..physics.lanes import COUNT, lanes_at, put_lanes, spread, total
from ..physics.motion import rates
from ..physics.rotation import quaternion_rate_world
from ..physics.state import (counts, omega_at, quaternion_at, velocity_at, work_at)
from ..physics.vector import dot

# Parts of what is kept of a spring at every stage: u, arm x u at P and at Q, the angular
# accelerations by these, stiffness, damping.
_ARMS, _RESPONSES, _STIFFNESS, _DAMPING = 3, 9, 15, 16
_ITERATIONS = 14
# The iteration need not be more exact than this, and what stalls below that is rounding.
_GOAL, _ROUNDING = 2e-14, 1e-10


@formula
def stages_of(memory, place, i, batch):
    """Return component i of a row of stages: stages 0 to 3, or 4 to 7, as Lanes."""
    return lanes_at(memory, place + STAGES * i + COUNT * batch)


@formula
def mix(table, columns, memory, place, batch):
    """Return the product of a matrix of the table with the stages at a place, as Lanes."""
    sum_ = lanes_at(table, columns + COUNT * batch) * memory[place]
    for j in range(1, STAGES):
        sum_ = sum_ + lanes_at(table, columns + STAGES * j + COUNT * batch) * memory[place + j]
    return sum_


@formula
def guess(bodies, rigid, size, table, h, y, rate, memory, here):
    """Write a guess of the stages: constant accelerations."""
    for batch in range(2):
        way = h * lanes_at(table, NODES + COUNT * batch)
        for i in range(size):
            value = y[i] + way * rate[i]
            if i < velocity_at(bodies):
                value = value + (0.5 * way) * (way * rate[velocity_at(bodies) + i])
            put_lanes(memory, here + STAGES * i + COUNT * batch, value)


@formula
def stage_rates(model, drive, table, size, t, h, memory, here, out, y, f):
    """Write the rates of all stages at `here` to `out`; y, f: Cells to use."""
    for batch in range(2):
        for i in range(size):
            y[i] = stages_of(memory, here, i, batch)
        rates(model, drive, t + h * lanes_at(table, NODES + COUNT * batch), y, f)
        for i in range(size):
            put_lanes(memory, out + STAGES * i + COUNT * batch, f[i])


@formula
def integrate(table, first, last, h, y, memory, rate, out):
    """Write to `out` the stages y + h A rate of the components `first` to `last` - 1."""
    for i in range(first, last):
        for batch in range(2):
            put_lanes(memory, out + STAGES * i + COUNT * batch,
                      y[i] + h * mix(table, A, memory, rate + STAGES * i, batch))


@formula
def quaternion_stages(bodies, rigid, memory, here, new, rate):
    """Write the rates of the orientations `here` with the angular velocities `new`."""
    for i in range(rigid):
        q, w = quaternion_at(bodies) + 4 * i, omega_at(bodies, rigid) + 3 * i
        for batch in range(2):
            change = quaternion_rate_world(
                (stages_of(memory, here, q, batch), stages_of(memory, here, q + 1, batch),
                 stages_of(memory, here, q + 2, batch), stages_of(memory, here, q + 3, batch)),
                (stages_of(memory, new, w, batch), stages_of(memory, new, w + 1, batch),
                 stages_of(memory, new, w + 2, batch)))
            for k in range(4):
                put_lanes(memory, rate + STAGES * (q + k) + COUNT * batch, change[k])


@formula
def integrate_all(bodies, rigid, size, table, h, y, memory, here, rate, new):
    """Write new stages: velocities from the rates, then positions and orientations from these."""
    integrate(table, velocity_at(bodies), quaternion_at(bodies), h, y, memory, rate, new)
    integrate(table, omega_at(bodies, rigid), size, h, y, memory, rate, new)
    for i in range(3 * bodies):
        for batch in range(2):
            put_lanes(memory, new + STAGES * i + COUNT * batch, y[i] + h * mix(
                table, A, memory, new + STAGES * (velocity_at(bodies) + i), batch))
    quaternion_stages(bodies, rigid, memory, here, new, rate)
    integrate(table, quaternion_at(bodies), omega_at(bodies, rigid), h, y, memory, rate, new)


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
    for s in range(group_size(connections, stiffness)):
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
def fill_system(several, bodies, rigid, count, spring_bodies, mass, table, h, memory, here, new,
                springs, matrix, pulls):
    """Write the equations of the changes of the springs' pulls, columns of the matrix in a row."""
    total_ = STAGES * count
    for j in range(count):
        place = springs + STAGES * STAGE_SPRING_SIZE * j
        stiffness, damping = memory[place + STAGES * _STIFFNESS], memory[place + STAGES * _DAMPING]
        for batch in range(2):
            length, speed = stretch(several, bodies, rigid, spring_bodies, j, memory, here, new,
                                    place, batch)
            put_lanes(memory, pulls + STAGES * j + COUNT * batch,
                      stiffness * length + damping * speed)
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
                                coupling = coupling + (sign / mass[i]) * dot(
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
def solve(count, memory, matrix, x):
    """Replace memory[x:] by the solution of the system; columns in a row, largest pivots."""
    for k in range(count):
        pivot = k
        for i in range(k + 1, count):
            if abs(memory[matrix + count * k + i]) > abs(memory[matrix + count * k + pivot]):
                pivot = i
        if pivot != k:
            for j in range(k, count):
                a, b = matrix + count * j + k, matrix + count * j + pivot
                memory[a], memory[b] = memory[b], memory[a]
            memory[x + k], memory[x + pivot] = memory[x + pivot], memory[x + k]
        inverse = 1.0 / memory[matrix + count * k + k]
        for i in range(k + 1, count):
            memory[matrix + count * k + i] *= inverse
        for j in range(k + 1, count):
            factor = memory[matrix + count * j + k]
            for i in range(k + 1, count):
                memory[matrix + count * j + i] -= factor * memory[matrix + count * k + i]
        for i in range(k + 1, count):
            memory[x + i] -= memory[x + k] * memory[matrix + count * k + i]
    for k in range(count - 1, -1, -1):
        memory[x + k] /= memory[matrix + count * k + k]
        for i in range(k):
            memory[x + i] -= memory[x + k] * memory[matrix + count * k + i]


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
def correct(model, drive, bodies, rigid, size, connections, groups, table, t, h, y, memory, here,
            rate, new, springs, cells, responses):
    """Let the new stages be those with the springs' forces at them, to first order."""
    if groups is not None:
        count = spring_count(connections)
        pulls = springs + STAGES * STAGE_SPRING_SIZE * count
        matrix = pulls + STAGES * count
        gather(model, drive, bodies, rigid, groups, table, size, t, h, memory, here, springs,
               cells, responses)
        fill_system(model.several, bodies, rigid, count, model.spring_bodies, model.mass, table, h,
                    memory, here, new, springs, matrix, pulls)
        solve(STAGES * count, memory, matrix, pulls)
        relieve(model.several, bodies, rigid, count, model.spring_bodies, model.mass, memory,
                springs, pulls, rate)
        integrate_all(bodies, rigid, size, table, h, y, memory, here, rate, new)


@formula
def replace_stages(size, y, memory, here, new):
    """Copy the new stages; return the largest change, over max(1, size at the start)."""
    largest = 0.0
    for i in range(size):
        scale = max(1.0, abs(y[i]))
        for stage in range(STAGES):
            at_here, at_new = here + STAGES * i + stage, new + STAGES * i + stage
            change = abs(memory[at_new] - memory[at_here]) / scale
            if not change <= largest:
                largest = change
            memory[at_here] = memory[at_new]
    return largest


@formula
def here_place(size, connections):
    """Return where the stages lie; `size`: of the whole state."""
    return stage_place(size, spring_count(connections))


@formula
def radau(model, drive, table, size, t, h, y, rate, tolerance, memory, y_new, error):
    """
    Take one step and estimate its error; return the number of evaluations in a row.

    table: radau_tableau.table(); tolerance: of the step, as error_norm has it; else as for gragg.
    Where the iteration fails the error estimate asks for a shorter step.
    """
    bodies, rigid = counts(model)
    cells = lane_row(model.several, memory, 0, size)
    f = lane_row(model.several, memory, 1, size)
    responses = lane_row(model.several, memory, 2, size)
    full = work_at(bodies, rigid) + 4
    here = here_place(full, model.connections)
    rates_at, new = here + STAGES * full, here + 2 * STAGES * full
    springs = here + STAGE_ROWS * STAGES * full
    guess(bodies, rigid, size, table, h, y, rate, memory, here)
    goal, last, evaluations, converged = max(0.1 * tolerance, _GOAL), math.inf, 0, False
    for iteration in range(_ITERATIONS):
        stage_rates(model, drive, table, size, t, h, memory, here, rates_at, cells, f)
        evaluations += 2
        integrate_all(bodies, rigid, size, table, h, y, memory, here, rates_at, new)
        correct(model, drive, bodies, rigid, size, model.connections, model.springs, table, t, h,
                y, memory, here, rates_at, new, springs, cells, responses)
        change = replace_stages(size, y, memory, here, new)
        converged = change <= goal
        # Rounding ends the iteration, too.
        stalled = iteration > 2 and not change < 0.8 * last
        if stalled and change <= max(10.0 * goal, _ROUNDING):
            converged = True
        if converged or stalled:
            break
        last = change
    for i in range(size):
        y_new[i] = memory[here + STAGES * i + STAGES - 1]
        interior, slope = 0.0, 0.0
        for batch in range(2):
            way = stages_of(memory, here, i, batch) - y[i]
            interior += total(lanes_at(table, ERROR + COUNT * batch) * way)
            slope += total(lanes_at(table, SLOPE + COUNT * batch) * way)
        # The stages do not see what happens just after the start: the rate there does.
        start = CAUTION * (h * rate[i] - slope)
        error[i] = start if abs(start) > abs(interior) else interior
    if not converged:
        for i in range(size):
            y_new[i] = y[i]
            error[i] = 0.0
        error[0] = 1e3 * tolerance * max(1.0, abs(y[0]))
    return evaluations


@formula
def dense_radau(model, table, size, y, memory, dense):
    """Write the polynomials of the last step: through its start and its stages."""
    bodies, rigid = counts(model)
    here = here_place(work_at(bodies, rigid) + 4, model.connections)
    for i in range(size):
        for d in range(DENSE_SIZE):
            value = y[i] if d == 0 else 0.0
            for stage in range(STAGES):
                value += table[STAGES * d + stage] * (memory[here + STAGES * i + stage] - y[i])
            dense[size * d + i] = value
    return 0
