# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
One step of Gragg's extrapolated midpoint rule, its sub-sequences side by side in Lanes.

y[1] = y[0] + h f(y[0]), y[i + 1] = y[i - 1] + 2 h f(y[i]): for an even number of substeps the
error has even powers of h only, so that each sequence raises the order by two.

W. B. Gragg, SIAM J. Numer. Anal. 2 (1965) 384; Hairer, Norsett, Wanner, Solving Ordinary
Differential Equations I, II.9. That the sequences are independent is as old; in the four lanes
a step takes as long as the evaluations of its longest sequence. Short sequences would not shorten
that, and are worth less than longer ones.
"""

from .lane_schedule import (add_ended, begin_sums, combine, ENDED, FINER, FIRST, place_of,
                            schedule, SECOND, Sequences)
from .memory import lane_row
from ..physics.advancing import Advancing
from ..physics.arms import (arm_of_state, begin_arm, put_arm, restart_arm, step_arm,
                            with_arm)
from ..physics.jit import part
from ..physics.lanes import choose, lanes_at, spread
from ..physics.motion import put_rates
from ..physics.reach import put_reach, reach_of_state
from ..physics.reaches import put_reaches, reaches_of_state, with_reaches

# Found by trying all that fit into the lanes, on spheres, chains and webs.
SEQUENCES = (
    Sequences(2e-5, (10, 16, 22, 24, 26), share=2.0, reach=4.0),
    Sequences(1.5e-8, (6, 8, 10, 12, 14, 16, 22)),
    Sequences(3e-11, (6, 8, 10, 12, 14, 16, 22), dense_substeps=FINER),
    # More of them than stages: their weights let a quarter of the rounding through.
    Sequences(0.0, (8, 10, 12, 14, 16, 18, 26), 6, dense_substeps=FINER))
# Bodies that hang on each other pass on what is rounded: it counts sooner, unless they are so few
# that the reaches of their springs are kept.
SEQUENCES_OF_SEVERAL = (*SEQUENCES[:2], SEQUENCES[2]._replace(least=2e-10), SEQUENCES[3])
SEQUENCES_OF_FEW = (*SEQUENCES[:2], SEQUENCES[2]._replace(least=0.0, keeps_reaches=True))


def gragg_schedule(substeps=SEQUENCES[1].substeps, stages=None):
    """Return the Schedule of the method of order 2 stages; see lane_schedule.schedule."""
    return schedule(substeps, 2, lambda n: n - 1, stages)


@part
def midpoint(model, drive, t, way, h, y, arm, reach, reaches, behind, here, state, f,
             following):
    """
    Put behind + 2 h f(here) where `behind` was.

    model: as from with_arm and with_reaches; behind, here: Lanes, less the state y at the start
    and its arm: sums of small numbers are rounded less; t: [s] of the start; way: Lanes, from it
    to the time of `here`; state: y + here, following: becomes y + behind; f: Cells to use.
    """
    put_arm(arm, here, state)
    put_reach(reach, way, here, state)
    put_reaches(model, drive, reaches, way, here, state)
    put_rates(model, drive, t + way, state, f, Advancing(h + h, behind, y, following))
    step_arm(arm, h, state, behind)


@part
def gragg(model, drive, plan, size, t, step, y, rate, memory, y_new, error):
    """
    Take one step and estimate its error.

    plan: Schedule; t: [s] as for rates; step: [s]; y, rate: Cells, state and its rate at t; y_new,
    error: Cells for the results. First sequences end in rows 0, 2, …, with their result in a;
    second ones in rows 1, 3, …, with theirs in b.
    """
    a = lane_row(model.several, memory, 0, size)
    b = lane_row(model.several, memory, 1, size)
    f = lane_row(model.several, memory, 2, size)
    sums = lane_row(model.several, memory, 3, size)
    state = lane_row(model.several, memory, 4, size)
    errors = lane_row(model.several, memory, 5, size)
    following = lane_row(model.several, memory, 6, size)
    table = plan.table
    h, h_second = step / lanes_at(table, FIRST), step / lanes_at(table, SECOND)
    way = h
    whole, arm = with_arm(with_reaches(model)), arm_of_state(model, y)
    reach = reach_of_state(model, drive, t, y, arm)
    reaches = reaches_of_state(model, drive, t, y)
    begin_arm(arm, h, y, a, b)
    for i in range(size):
        a[i] = spread(0.0)
        b[i] = h * rate[i]
        state[i] = y[i] + b[i]
    begin_sums(size, sums, errors)
    for row in range(0, plan.rows, 2):
        midpoint(whole, drive, t, way, h, y, arm, reach, reaches, a, b, state, f, following)
        way = way + h
        if plan.ends[row]:
            add_ended(table, row, size, a, sums, errors)
            ended = lanes_at(table, place_of(row, ENDED))
            for i in range(size):
                b[i] = choose(ended, 0.0, b[i])
                a[i] = choose(ended, h_second * rate[i], a[i])
                following[i] = y[i] + a[i]
            restart_arm(arm, ended, h_second, y, a, b)
            way = choose(ended, h_second, way)
            h = choose(ended, h_second, h)
        if row == plan.rows - 1:
            break
        midpoint(whole, drive, t, way, h, y, arm, reach, reaches, b, a, following, f, state)
        way = way + h
        if plan.ends[row + 1]:
            add_ended(table, row + 1, size, b, sums, errors)
    combine(size, y, sums, errors, y_new, error)
