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

from .lane_schedule import combine, ENDS, FIRST, schedule, SECOND
from .memory import lane_row
from ..physics.fused import fused
from ..physics.jit import formula
from ..physics.lanes import choose, COUNT, lanes_at, spread
from ..physics.motion import accelerations
from ..physics.state import counts

SUBSTEPS = (1, 2, 3, 4, 5, 6, 7)


def stormer_schedule(substeps=SUBSTEPS, stages=None):
    """Return the Schedule of the method of order 2 stages; see lane_schedule.schedule."""
    return schedule(substeps, 2, lambda n: n, stages)


@formula
def anchor_work(works, size, h, f, sums):
    """Add h times the power of the anchors to their work (trapezoidal rule), if it is counted."""
    if works is not None:
        sums[size - 2] = sums[size - 2] + h * f[size - 2]


@formula
def push_work(works, pushes, bodies, y, y_new):
    """Add the work of constant commanded forces: force times way, if it is counted."""
    if works is not None:
        if pushes is not None:
            for i in range(3 * bodies):
                y_new[6 * bodies + 3] = (y_new[6 * bodies + 3]
                                         + pushes[3 * bodies + i] * (y_new[i] - y[i]))


@formula
def begin(works, bodies, size, h, y, rate, ended, d, x):
    """Let lanes in which a sequence has ended begin another; x: states less y."""
    half = 0.5 * (h * h)
    for i in range(3 * bodies):
        d[i] = choose(ended, half * rate[3 * bodies + i], d[i])
        x[i] = choose(ended, fused(h, y[3 * bodies + i], d[i]), x[i])
    if works is not None:
        x[size - 2] = choose(ended, (0.5 * h) * rate[size - 2], x[size - 2])


@formula
def reach(works, bodies, size, h, per_h, x, d, f, out):
    """Write what the sequences have reached, less y."""
    n = 3 * bodies
    for i in range(n):
        out[i] = x[i]
        out[n + i] = d[i] * per_h + (0.5 * h) * f[n + i]
    if works is not None:
        out[size - 2] = x[size - 2] - (0.5 * h) * f[size - 2]


@formula
def stormer(model, drive, plan, size, t, step, y, rate, memory, y_new, error):
    """
    Take one step and estimate its error; arguments as for gragg.

    Second sequences all end in the last row.
    """
    x = lane_row(model.several, memory, 0, size)
    d = lane_row(model.several, memory, 1, size)
    f = lane_row(model.several, memory, 2, size)
    first = lane_row(model.several, memory, 3, size)
    reached = lane_row(model.several, memory, 4, size)
    state = lane_row(model.several, memory, 5, size)
    bodies, _ = counts(model)
    table = plan.table
    h, h_second = step / lanes_at(table, FIRST), step / lanes_at(table, SECOND)
    per_h = 1.0 / h
    for i in range(size):
        first[i] = spread(0.0)
        reached[i] = spread(0.0)
        d[i] = spread(0.0)
        x[i] = spread(0.0)
        state[i] = spread(0.0)
    begin(drive.works, bodies, size, h, y, rate, spread(1.0), d, x)
    now = t + h
    for row in range(plan.rows):
        for i in range(3 * bodies):
            state[i] = y[i] + x[i]
        accelerations(model, drive, now, state, f)
        anchor_work(drive.works, size, h, f, x)
        if row >= plan.first_end:
            ended = lanes_at(table, ENDS + COUNT * row)
            reach(drive.works, bodies, size, h, per_h, x, d, f, reached)
            for i in range(size):
                first[i] = choose(ended, reached[i], first[i])
        for i in range(3 * bodies):
            d[i] = fused(h * h, f[3 * bodies + i], d[i])
            x[i] = fused(h, y[3 * bodies + i], x[i]) + d[i]
        now = now + h
        if row >= plan.first_end:
            begin(drive.works, bodies, size, h_second, y, rate, ended, d, x)
            now = choose(ended, t + h_second, now)
            per_h = choose(ended, 1.0 / h_second, per_h)
            h = choose(ended, h_second, h)
    second = lanes_at(table, ENDS + COUNT * (2 * plan.rows - 1))
    for i in range(size):
        reached[i] = choose(second, reached[i], 0.0)
    combine(table, size, y, first, reached, y_new, error)
    push_work(drive.works, drive.pushes, bodies, y, y_new)
