# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
What an integration keeps from one step to the next, as plain values, and put back again.

Next steps depend on more than the state: on where the grid began, on how long the last step was
and how well it went, on which method is at work and how many trials of the other one have failed.
With all of it put back, an integration goes on to the same bits. Scratch is left out: the
polynomial of the last step is there whenever a run has come to an instant within it.
"""

from functools import singledispatch

from ..integrators.adaptive_steps import AdaptiveSteps
from ..integrators.auto_motion import AutoMotion
from ..integrators.auto_steps import AutoSteps
from ..integrators.fixed_steps import FixedSteps


@singledispatch
def remember(steps):
    """Return what `new_steps` returned as a dict of numbers, lists and such dicts."""
    raise TypeError(steps)


@singledispatch
def recall(steps, memory, begun):
    """
    Put what `remember` returned back into new steps of the same settings, model and drive.

    begun: (time [ns], state) when and where the motion began, None if it is to begin now. Raises
    ValueError, KeyError or TypeError for what is no such memory.
    """
    raise TypeError(steps)


@remember.register
def _(steps: FixedSteps):
    kept = {'removed': float(steps.removed), 'steps': int(steps.steps)}
    if hasattr(steps, '_grid'):
        # It is there as soon as a motion has begun.
        kept |= {'origin': steps._origin, 'grid': steps._grid, 'state': steps._state.tolist()}
    return kept


@recall.register
def _(steps: FixedSteps, memory, begun):
    steps.removed, steps.steps = float(memory['removed']), int(memory['steps'])
    if begun is not None:
        steps.begin(*begun)
        steps._state[:] = memory['state']
        steps._origin, steps._grid = int(memory['origin']), int(memory['grid'])


@remember.register
def _(steps: AdaptiveSteps):
    return {**_idle(steps), 'states': steps.states.tolist(), 'polynomial': steps._dense.tolist()}


@recall.register
def _(steps: AdaptiveSteps, memory, begun):
    _put_idle(steps, memory)
    steps.states[:] = memory['states']
    steps._dense[:] = memory['polynomial']


def _idle(steps):
    """Return what counts of AdaptiveSteps even while others are at work."""
    return {'origin': steps.origin, 'clock': steps.clock.tolist(),
            'counts': steps.counts.tolist(), 'watch': float(steps.watch),
            'calm': float(steps.calm)}


def _put_idle(steps, memory):
    steps.origin = int(memory['origin'])
    steps.clock[:] = memory['clock']
    steps.counts[:] = memory['counts']
    steps.watch, steps.calm = float(memory['watch']), float(memory['calm'])


@remember.register
def _(steps: AutoSteps):
    return {'is_stiff': steps.current is steps.stiff, 'at_work': remember(steps.current),
            'explicit': _idle(steps.explicit),
            'stiff': None if steps.stiff is None else _idle(steps.stiff),
            'entered': int(steps._entered),
            'asleep_at': None if steps._asleep_at is None else float(steps._asleep_at)}


@recall.register
def _(steps: AutoSteps, memory, begun):
    _put_idle(steps.explicit, memory['explicit'])
    if memory['stiff'] is not None:
        steps.stiff = steps._new_stiff()
        _put_idle(steps.stiff, memory['stiff'])
    steps.current = steps.stiff if memory['is_stiff'] else steps.explicit
    recall(steps.current, memory['at_work'], begun)
    steps._entered, asleep_at = int(memory['entered']), memory['asleep_at']
    steps._asleep_at = None if asleep_at is None else float(asleep_at)


@remember.register
def _(motion: AutoMotion):
    return {'is_closed': motion._current is motion._closed,
            'steps': None if motion._steps is None else remember(motion._steps)}


@recall.register
def _(motion: AutoMotion, memory, begun):
    if memory['steps'] is not None:
        recall(motion._all_steps(), memory['steps'], begun)
    if not memory['is_closed']:
        motion._current = motion._all_steps()
    elif begun is not None and not motion._closed.begin(*begun):
        raise ValueError('its motion has no closed form here')
