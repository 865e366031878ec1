# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
One step of the extrapolated linearly implicit Euler method, its sub-sequences in Lanes.

For stiff springs and strong dampers: steps are as long as the slow motion allows, however short
the period of the springs. Substeps 1, 2, 3, …; the error of the first result has all powers of h.

Deuflhard, SIAM Review 27 (1985) 505; Hairer, Wanner, Solving Ordinary Differential Equations II,
IV.9.
"""

from .lane_schedule import (add_ended, begin_sums, combine, ENDED, FIRST, place_of, schedule,
                            SECOND)
from .linearly_implicit import linearly_implicit_substep
from .memory import lane_row
from ..physics.jit import formula
from ..physics.lanes import choose, lanes_at, spread

SUBSTEPS = (1, 2, 3, 4, 5, 6, 7)


def stiff_schedule(substeps=SUBSTEPS, stages=None):
    """Return the Schedule of the method whose order is stages; see lane_schedule.schedule."""
    return schedule(substeps, 1, lambda n: n, stages)


@formula
def stiff(model, drive, plan, size, t, step, y, memory, y_new, error):
    """Take one step and estimate its error; arguments as for gragg."""
    here = lane_row(model.several, memory, 0, size)
    sums = lane_row(model.several, memory, 1, size)
    errors = lane_row(model.several, memory, 2, size)
    f = lane_row(model.several, memory, 3, size)
    responses = lane_row(model.several, memory, 4, size)
    reached = lane_row(model.several, memory, 5, size)
    table = plan.table
    h, h_second = step / lanes_at(table, FIRST), step / lanes_at(table, SECOND)
    for i in range(size):
        here[i] = spread(y[i])
    begin_sums(size, sums, errors)
    now = spread(t)
    for row in range(plan.rows):
        linearly_implicit_substep(model, drive, now, h, memory, here, f, responses)
        now = now + h
        if plan.ends[row]:
            for i in range(size):
                reached[i] = here[i] - y[i]
            add_ended(table, row, size, reached, sums, errors)
            ended = lanes_at(table, place_of(row, ENDED))
            for i in range(size):
                here[i] = choose(ended, y[i], here[i])
            now = choose(ended, t, now)
            h = choose(ended, h_second, h)
    combine(size, y, sums, errors, y_new, error)
