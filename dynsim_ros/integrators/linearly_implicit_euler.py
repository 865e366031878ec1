# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The linearly implicit Euler method with steps of one length: stable however stiff a spring is.

Order 1; what is too fast for the step comes to rest, also where nothing damps it. The substep of
the extrapolated method with the same numbers in all Lanes.
"""

from .linearly_implicit import linearly_implicit_substep
from .memory import lane_row, load, number_row, store
from ..physics.jit import kernel
from ..physics.lanes import lane, spread
from ..physics.state import counts, moving_size, normalise


@kernel
def advance(model, drive, t_ns, h_ns, steps, state, memory):
    """Take a number of steps of one length; see Method for the arguments."""
    bodies, rigid = counts(model)
    size = moving_size(drive.works, bodies, rigid)
    y = number_row(model.several, memory, 0, size)
    here = lane_row(model.several, memory, 0, size)
    f = lane_row(model.several, memory, 1, size)
    responses = lane_row(model.several, memory, 2, size)
    load(size, state, y)
    h = h_ns * 1e-9
    removed = 0.0
    for k in range(steps):
        for i in range(size):
            here[i] = spread(y[i])
        linearly_implicit_substep(model, drive, spread((t_ns + k * h_ns) * 1e-9), spread(h),
                                  memory, here, f, responses)
        for i in range(size):
            y[i] = lane(here[i], 0)
        removed += normalise(bodies, rigid, y)
    store(size, y, state)
    return removed
