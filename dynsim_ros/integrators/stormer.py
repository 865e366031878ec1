# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
One step of Störmer's rule, extrapolated: for particles whose forces depend on positions alone.

d[0] = h^2 a(x[0]) / 2, x[i + 1] = x[i] + h v[0] + d[i], d[i] = d[i - 1] + h^2 a(x[i]), and at the
end v = v[0] + d[n - 1] / h + h a(x[n]) / 2: even powers of h for any number of substeps, so that
an order costs half of the evaluations that Gragg's rule needs. As d is what the forces change, it
is small, and so is its rounding, which the extrapolation multiplies.

Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, II.14.
"""

from .lane_schedule import (add_ended, begin_sums, combine, ENDED, FIRST, place_of, schedule,
                            SECOND, Sequences)
from .memory import lane_row
from ..physics.advancing import Advancing
from ..physics.fused import fused
from ..physics.jit import formula
from ..physics.lanes import choose, lanes_at, spread
from ..physics.motion import put_accelerations
from ..physics.state import counts

# Found by trying all that fit into the lanes, on particles, for errors at the end and of samples.
# Where less is asked for, the first ones take less time.
SEQUENCES = (Sequences(2e-8, (5, 7, 10, 11, 12), share=2.0, reach=5.0),
             Sequences(0.0, (4, 5, 6, 7, 10, 11), share=0.7, reach=4.2))


def stormer_schedule(substeps=SEQUENCES[0].substeps, stages=None):
    """Return the Schedule of the method of order 2 stages; see lane_schedule.schedule."""
    return schedule(substeps, 2, lambda n: n, stages)


@formula
def anchor_work(works, size, h, f, work):
    """Return the work of the anchors after a substep (trapezoidal rule), if it is counted."""
    if works is not None:
        return work + h * f[size - 2]
    return work


@formula
def push_work(works, pushes, bodies, y, y_new):
    """Add the work of constant commanded forces: force times way, if it is counted."""
    if works is not None:
        if pushes is not None:
            for i in range(3 * bodies):
                y_new[6 * bodies + 3] = (y_new[6 * bodies + 3]
                                         + pushes[3 * bodies + i] * (y_new[i] - y[i]))


@formula
def begin(works, bodies, size, h, y, rate, ended, d, x, work):
    """Let lanes in which a sequence has ended begin another; return the work of the anchors."""
    half = 0.5 * (h * h)
    for i in range(3 * bodies, 6 * bodies):
        d[i] = choose(ended, half * rate[i], d[i])
        x[i] = choose(ended, fused(h, y[i], d[i]), x[i])
    if works is not None:
        return choose(ended, (0.5 * h) * rate[size - 2], work)
    return work


@formula
def reach(works, bodies, size, h, half_per_h, d, f, work, reached):
    """Write what the sequences have reached, less y; reached: has x, and d before the substep."""
    for i in range(3 * bodies, 6 * bodies):
        reached[i] = half_per_h * (reached[i] + d[i])
    if works is not None:
        reached[size - 2] = work - (0.5 * h) * f[size - 2]


@formula
def stormer(model, drive, plan, size, t, step, y, rate, memory, y_new, error):
    """
    Take one step and estimate its error; arguments as for gragg.

    d, and the way x from the start of the step, lie where velocities are in a state.
    """
    x = lane_row(model.several, memory, 0, size)
    d = lane_row(model.several, memory, 1, size)
    f = lane_row(model.several, memory, 2, size)
    sums = lane_row(model.several, memory, 3, size)
    reached = lane_row(model.several, memory, 4, size)
    state = lane_row(model.several, memory, 5, size)
    errors = lane_row(model.several, memory, 6, size)
    ahead = lane_row(model.several, memory, 7, size)
    bodies, _ = counts(model)
    n, table = 3 * bodies, plan.table
    h, h_second = step / lanes_at(table, FIRST), step / lanes_at(table, SECOND)
    half_per_h = 0.5 / h
    for i in range(size):
        reached[i] = spread(0.0)
        d[i] = spread(0.0)
        x[i] = spread(0.0)
        state[i] = spread(0.0)
        ahead[i] = spread(0.0)
    begin_sums(size, sums, errors)
    work = begin(drive.works, bodies, size, h, y, rate, spread(1.0), d, x, spread(0.0))
    now = t + h
    for row in range(plan.rows):
        for i in range(n):
            state[i] = y[i] + x[n + i]
            reached[i], reached[n + i] = x[n + i], d[n + i]
            ahead[n + i] = fused(h, y[n + i], x[n + i])
        put_accelerations(model, drive, now, state, f, Advancing(h * h, d, ahead, x))
        work = anchor_work(drive.works, size, h, f, work)
        now = now + h
        if plan.ends[row]:
            reach(drive.works, bodies, size, h, half_per_h, d, f, work, reached)
            add_ended(table, row, size, reached, sums, errors)
            ended = lanes_at(table, place_of(row, ENDED))
            work = begin(drive.works, bodies, size, h_second, y, rate, ended, d, x, work)
            now = choose(ended, t + h_second, now)
            half_per_h = choose(ended, 0.5 / h_second, half_per_h)
            h = choose(ended, h_second, h)
    combine(size, y, sums, errors, y_new, error)
    push_work(drive.works, drive.pushes, bodies, y, y_new)
