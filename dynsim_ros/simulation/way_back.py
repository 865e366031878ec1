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
    return lambda: None  # it keeps nothing


@way_back.register
def _(steps: FixedSteps):
    grid, state, removed, taken = steps._grid, steps._state.copy(), steps.removed, steps.steps

    def go_back():
        steps._grid, steps._state[:] = grid, state
        steps.removed, steps.steps = removed, taken

    return go_back


@way_back.register
def _(steps: AdaptiveSteps):
    arrays = steps._kept, steps.states, steps._dense
    copies = [array.copy() for array in arrays]
    origin, watch, calm = steps.origin, steps.watch, steps.calm

    def go_back():
        for array, kept in zip(arrays, copies):
            array[:] = kept
        steps.origin, steps.watch, steps.calm = origin, watch, calm

    return go_back


@way_back.register
def _(steps: AutoSteps):
    parts = [way_back(part) for part in filter(None, (steps.explicit, steps.stiff))]
    at_work = (steps.stiff, steps.current, steps._wait, steps._next_trial, steps._entered,
               steps._asleep_at)

    def go_back():
        for part in parts:
            part()
        (steps.stiff, steps.current, steps._wait, steps._next_trial, steps._entered,
         steps._asleep_at) = at_work

    return go_back


@way_back.register
def _(motion: AutoMotion):
    return way_back(motion._current)
