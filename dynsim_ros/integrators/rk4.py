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
def advance(model, anchors, pushes, t_ns, h_ns, steps, y, work):
    """
    Take a number of steps of length h_ns, beginning at time t_ns.

    model: Model; anchors: (n, 6) position [m] and velocity [m/s] in world at time 0; pushes:
    forces [N] and torques [N m] laid out as the state; t_ns, h_ns: integers [ns], so that the
    times of the steps do not depend on how many of them are taken at once; y: state, replaced;
    work: (5, state_size), overwritten.
    Returns the sum over the steps of what normalising the quaternions removed.
    """
    k1, k2, k3, k4, stage = work[0], work[1], work[2], work[3], work[4]
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
