# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How fast the fastest motion of a model can be: a bound, from what is pulled by what."""

import math

import numpy as np

# Beyond this over the fastest rate a step of an explicit method may be held back by its stability
# rather than by its accuracy; the stabler ones among them reach farther.
EXPLICIT_REACH = 3.0


def easiest_turns(model):
    """Return (bodies,) the largest inverse moment of inertia of each, 0 for particles."""
    easiest = np.zeros(len(model.mass))
    if model.round_body is not None:
        easiest[model.round_body] = model.inverse_round_inertia
    if model.general_body is not None:
        # The trace of a positive matrix is above its largest eigenvalue.
        easiest[model.general_body] = [matrix[0, 0] + matrix[1, 1] + matrix[2, 2]
                                       for matrix in model.inverse_inertia]
    return easiest


def drag_rate(model):
    """Return the fastest rate at which the air slows a body down [1/s]."""
    if model.air is None:
        return 0.0
    return max((model.air.linear_drag or 0.0) / model.mass.min(),
               (model.air.rotational_drag or 0.0) * easiest_turns(model).max())


def spring_rates(model):
    """Return bounds of the rates of springs, of oscillation, and of dampers, of decay [1/s]."""
    lightness, easiest = model.inverse_mass, easiest_turns(model)
    stiffness, damping = np.zeros(len(model.mass)), np.zeros(len(model.mass))
    for group in model.springs or ():
        for ends in (group.p, group.q):
            index = ends.body if ends.particle is None else ends.particle
            if index is None:
                continue
            arm = np.zeros(len(index))
            if ends.offset is not None:
                x, y, z = ends.offset.T
                arm = x * x + y * y + z * z
            mobility = lightness[index] + arm * easiest[index]
            np.add.at(stiffness, index, group.stiffness * mobility)
            if group.damping is not None:
                np.add.at(damping, index, group.damping * mobility)
    # Two bodies of one spring pull each other: twice the larger one is a bound.
    return math.sqrt(2.0 * stiffness.max()), 2.0 * damping.max()


def fastest_rate(model):
    """Return a bound of the rates of oscillation and decay [1/s]; 0 where nothing pulls."""
    return max(*spring_rates(model), drag_rate(model))


def held_back_step(model, reach=EXPLICIT_REACH):
    """Return the explicit step [s] that may be as long as stability allows, or infinity."""
    rate = fastest_rate(model)
    return reach / rate if rate > 0.0 else math.inf
