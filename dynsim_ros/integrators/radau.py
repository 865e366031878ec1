# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
One step of the Radau IIA method with eight stages, order 15, its stages side by side in Lanes.

For stiff springs where the slow motion has to be exact: L-stable, and of order 8 at least whatever
the stiffness. The stages solve a system of equations; it is iterated with the forces as they are,
but for the springs and dampers, whose stiffness is in the iteration's matrix. It begins with the
polynomial of the step before, and computes the matrix again as long as that makes a difference.
The stages stay in the memory: they are the dense output.

Hairer, Wanner, Solving Ordinary Differential Equations II, IV.5, IV.8, VII.4.
"""

import math

from .linearly_implicit import spring_count
from .memory import DENSE_SIZE, lane_row, stage_place, STAGE_ROWS, STAGES
from .radau_tableau import CAUTION, ERROR, SLOPE
from .stage_springs import correct, solver_places
from .stages import (extrapolate, guess, integrate_all, keep, replace_stages, stage_rates,
                     stages_of)
from ..physics.jit import formula
from ..physics.lanes import COUNT, lanes_at, total
from ..physics.state import counts, work_at

_ITERATIONS = 14
# The iteration need not be more exact than this, and what stalls below that is rounding.
_GOAL, _ROUNDING = 2e-14, 1e-10
# After a smaller change of the stages the matrix of the iteration is not computed again.
_SETTLED = 1e-2


@formula
def here_place(size, connections):
    """Return where the stages lie; `size`: of the whole state."""
    return stage_place(size, spring_count(connections))


@formula
def radau(model, drive, table, size, t, h, y, rate, tolerance, h_before, kept, memory, y_new,
          error):
    """
    Take one step and estimate its error; return the number of evaluations in a row.

    table: radau_tableau.table(); tolerance: of the step, as error_norm has it; h_before: length of
    the step before, whose stages are kept by keep_stages; 0: they are not; else as for gragg.
    Where the iteration fails the error is infinite.
    """
    bodies, rigid = counts(model)
    cells = lane_row(model.several, memory, 0, size)
    f = lane_row(model.several, memory, 1, size)
    responses = lane_row(model.several, memory, 2, size)
    full = work_at(bodies, rigid) + 4
    here = here_place(full, model.connections)
    rates_at, new = here + STAGES * full, here + 2 * STAGES * full
    springs = here + STAGE_ROWS * STAGES * full
    if h_before > 0.0:
        _, weights, _ = solver_places(springs, spring_count(model.connections))
        extrapolate(size, table, h / h_before, y, kept, memory, here, weights)
    else:
        guess(bodies, rigid, size, table, h, y, rate, memory, here)
    goal, last, evaluations, converged = max(0.1 * tolerance, _GOAL), math.inf, 0, False
    for iteration in range(_ITERATIONS):
        stage_rates(model, drive, table, size, t, h, memory, here, rates_at, cells, f)
        evaluations += 2
        integrate_all(bodies, rigid, size, table, h, y, memory, here, rates_at, new)
        correct(model, drive, bodies, rigid, size, model.connections, model.springs, table, t, h,
                y, memory, here, rates_at, new, springs, cells, responses, last < _SETTLED)
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
        error[0] = math.inf
    return evaluations


@formula
def keep_stages(radau_data, model, size, memory, kept):
    """Keep the stages of a step for the next one; radau_data: None for another method."""
    if radau_data is not None:
        bodies, rigid = counts(model)
        keep(size, memory, here_place(work_at(bodies, rigid) + 4, model.connections), kept)


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
