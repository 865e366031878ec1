# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
How an integration that has gone ahead is taken back, to the same bits.

What it keeps from one step to the next is copied before; for what that is see step_memory. This
takes microseconds, as it has to where a step is taken while there is time, before it is due.
"""

from functools import singledispatch

from ..integrators.adaptive_steps import AdaptiveSteps
from ..integrators.auto_motion import AutoMotion
from ..integrators.auto_steps import AutoSteps
from ..integrators.closed_motion import ClosedMotion
from ..integrators.fixed_steps import FixedSteps


@singledispatch
def way_back(steps):
    """Return a function that puts what `new_steps` returned back to where it is now."""
    raise TypeError(steps)


@way_back.register
def _(motion: ClosedMotion):
    return _attributes_back(motion)


@way_back.register
def _(steps: FixedSteps):
    return _attributes_back(steps, [steps._state] if hasattr(steps, '_state') else [])


@way_back.register
def _(steps: AdaptiveSteps):
    return _attributes_back(steps, (steps._kept, steps.states, steps._dense))


@way_back.register
def _(steps: AutoSteps):
    return _all_back(steps, steps.explicit, steps.stiff)


@way_back.register
def _(motion: AutoMotion):
    return _all_back(motion, motion._closed, motion._steps)


def _all_back(whole, *parts):
    """Return way_back of something that is made of such things, or of None."""
    backs = [_attributes_back(whole), *map(way_back, filter(None, parts))]

    def go_back():
        for back in backs:
            back()

    return go_back


def _attributes_back(steps, arrays=()):
    """Return what puts back attributes, and the numbers in arrays that are changed in place."""
    attributes, copies = dict(vars(steps)), [array.copy() for array in arrays]

    def go_back():
        vars(steps).clear()
        vars(steps).update(attributes)
        for array, numbers in zip(arrays, copies):
            array[:] = numbers

    return go_back
