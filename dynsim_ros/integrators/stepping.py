# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which way a motion is advanced."""

from . import gragg, methods, stormer
from .adaptive_steps import AdaptiveSteps
from .auto_motion import AutoMotion
from .auto_steps import AutoSteps
from .fixed_steps import FixedSteps
from .lane_schedule import sequences_for
from .stiffness import drag_rate, spring_rates
from ..physics.structure import is_small

# From this tolerance on the linearly implicit method needs no more steps than collocation, whose
# steps cost several times as much; the cost of these grows with the cube of the number of springs,
# and their iteration does not know of the drag.
_COARSE, _MANY = 3e-4, 4


def needs_no_velocity(model):
    """Return whether all forces depend on positions alone, and nothing rotates."""
    return (model.rigid == 0 and model.air is None
            and all(group.damping is None for group in model.springs or ()))


def explicit_method(model, tolerance):
    """Return the Adaptive that extrapolation means for a model."""
    if needs_no_velocity(model):
        return methods.stormer_extrapolation(sequences_for(tolerance, stormer.SEQUENCES))
    if model.several is None:
        sequences = gragg.SEQUENCES
    else:
        sequences = gragg.SEQUENCES_OF_FEW if is_small(model) else gragg.SEQUENCES_OF_SEVERAL
    return methods.gragg_extrapolation(sequences_for(tolerance, sequences))


def stiff_method(model, springs, tolerance):
    """Return what makes the Adaptive for a stiff model, and its step's cost in explicit steps."""
    is_dragged = drag_rate(model) > 0.1 * max(spring_rates(model))
    if tolerance >= _COARSE or springs > _MANY or is_dragged:
        return methods.stiff, 1.2
    return methods.radau, 5.0


def new_steps(settings, model, drive, size):
    """
    Return what advances a state: it has begin, state_at and cut, as FixedSteps.

    settings: has integrator, step_ns and tolerance; size: length of the state.
    """
    method = methods.method_named(settings.integrator)
    springs = 0 if model.spring_bodies is None else len(model.spring_bodies)
    if method.advance is not None:
        return FixedSteps(method.advance, settings.step_ns, model, drive, size, springs)
    tolerance = settings.tolerance
    if method.name == 'auto':
        return AutoMotion(model, drive, lambda: AutoSteps(
            explicit_method(model, tolerance), *stiff_method(model, springs, tolerance),
            tolerance, model, drive, size, springs))
    adaptive = {'extrapolation': lambda: explicit_method(model, tolerance),
                'stiff': methods.stiff, 'radau': methods.radau,
                'dop853': methods.dop853}[method.name]()
    return AdaptiveSteps(adaptive, tolerance, model, drive, size, springs)
