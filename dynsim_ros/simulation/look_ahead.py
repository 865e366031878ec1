# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
How far ahead the states of a motion can be had at little cost.

A step of a method that chooses its steps is often as long as many ticks. Their states all come
out of its polynomial: in one go they cost little more than one of them alone. Steps of fixed
length are as cheap as that: many can be taken at once, and again where they were too many.
"""

from functools import singledispatch

from .settings import SECOND
from ..integrators.adaptive import BASE, END, STEP
from ..integrators.adaptive_steps import AdaptiveSteps, FAR
from ..integrators.auto_motion import AutoMotion
from ..integrators.auto_steps import AutoSteps
from ..integrators.fixed_steps import FixedSteps

# So many steps of fixed length are taken ahead at most, and so many ticks.
_MOST_STEPS = 64


def ticks_ahead(steps, tick_ns):
    """Return over how many ticks what `new_steps` returned is to step where none is known."""
    if not isinstance(steps, FixedSteps):
        return 1
    return min(max(_MOST_STEPS * steps.step_ns // tick_ns, 1), _MOST_STEPS)


@singledispatch
def known_until(steps):
    """
    Return an instant [ns] up to which `fill` of what `new_steps` returned takes no step.

    To be asked right after a state has been asked for. It is past where nothing is known.
    """
    return 0


@known_until.register
def _(steps: AdaptiveSteps):
    clock = steps.clock
    if not clock[STEP] > 0.0:
        return 0
    # Less than the last nanosecond: it may be beyond the end.
    return steps.origin + int(clock[BASE]) * SECOND + int(clock[END] * 1e9) - 1


@known_until.register
def _(steps: AutoSteps):
    return FAR if steps._is_asleep() else known_until(steps.current)


@known_until.register
def _(motion: AutoMotion):
    return FAR if motion._current is motion._closed else known_until(motion._current)
