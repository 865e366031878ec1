# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The classical Runge-Kutta method of order 4, quaternions normalised after every step."""

from .memory import load, number_row, store
from ..physics.fused import fused
from ..physics.jit import formula, kernel
from ..physics.motion import rates
from ..physics.state import counts, moving_size, normalise


@formula
def ahead(stage):
    """Return how far ahead in the step the stage after this one is: 1/2, 1/2, 1."""
    return 1.0 if stage == 2 else 0.5


@formula
def weight(stage):
    """Return the weight of a stage in the step: 1/6, 2/6, 2/6, 1/6."""
    return 2.0 / 6.0 if 0 < stage < 3 else 1.0 / 6.0


@kernel
def advance(model, drive, t_ns, h_ns, steps, state, memory):
    """Take a number of steps of one length; see Method for the arguments."""
    bodies, rigid = counts(model)
    size = moving_size(drive.works, bodies, rigid)
    y = number_row(model.several, memory, 0, size)
    at_stage = number_row(model.several, memory, 1, size)
    k = number_row(model.several, memory, 2, size)
    step = number_row(model.several, memory, 3, size)
    load(size, state, y)
    h = h_ns * 1e-9
    removed = 0.0
    for n in range(steps):
        now = (t_ns + n * h_ns) * 1e-9
        c = 0.0
        for i in range(size):
            at_stage[i] = y[i]
            step[i] = -0.0
        for stage in range(4):
            rates(model, drive, now + c * h, at_stage, k)
            w = weight(stage)
            c = ahead(stage)
            for i in range(size):
                step[i] = fused(w, k[i], step[i])
                at_stage[i] = fused(c * h, k[i], y[i])
        for i in range(size):
            y[i] = fused(h, step[i], y[i])
        removed += normalise(bodies, rigid, y)
    store(size, y, state)
    return removed
