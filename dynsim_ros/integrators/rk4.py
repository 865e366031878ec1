# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The classical Runge-Kutta method of order 4, quaternions normalised after every step."""

from ..physics.jit import formula, kernel
from ..physics.motion import rates
from ..physics.state import normalise


@formula
def add_scaled(y, s, k, out):
    """Write y + s k to out."""
    for i in range(y.shape[0]):
        out[i] = y[i] + s * k[i]


@kernel
def advance(model, anchors, pushes, t_ns, h_ns, steps, y, scratch):
    """Take a number of steps of one length; see Method for the arguments."""
    k1, k2, k3, k4 = scratch[0], scratch[1], scratch[2], scratch[3]
    stage = scratch[4]
    h = h_ns * 1e-9
    removed = 0.0
    for k in range(steps):
        now = (t_ns + k * h_ns) * 1e-9
        rates(model, anchors, pushes, now, y, k1)
        add_scaled(y, 0.5 * h, k1, stage)
        rates(model, anchors, pushes, now + 0.5 * h, stage, k2)
        add_scaled(y, 0.5 * h, k2, stage)
        rates(model, anchors, pushes, now + 0.5 * h, stage, k3)
        add_scaled(y, h, k3, stage)
        rates(model, anchors, pushes, now + h, stage, k4)
        for i in range(y.shape[0]):
            y[i] += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i])
        removed += normalise(model.mass.shape[0], model.rigid, y)
    return removed
