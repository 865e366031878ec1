# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A motion advanced in steps of one length, on a grid that begins where the motion is begun."""

import numpy as np

from .entry import entry
from .memory import new_memory
from ..physics.structure import with_structure


class FixedSteps:
    """
    Advances a state with a method of fixed step.

    advance: the method's kernel; step_ns: length of a step [ns]; model: Model; drive: Drive; size:
    length of the state; springs: how many the model has. At an instant between two points of the
    grid the state comes from a shorter step that is not kept.
    """

    shortfall = None

    def __init__(self, advance, step_ns, model, drive, size, springs):
        self._memory = new_memory(size, springs)
        self.step_ns = step_ns
        self._model, self._drive = with_structure(model), drive
        self._advance = entry(advance, self._model, drive, 0, 0, 0, np.zeros(size), self._memory)
        self.removed = 0.0
        self.steps = 0

    def begin(self, time_ns, state):
        """Let the grid begin at an instant, in a state: (size,)."""
        self._origin = self._grid = time_ns
        self._state = state.copy()

    def state_at(self, time_ns, limit_ns=None):
        """Return the state at an instant that is not before the last one asked for."""
        steps, rest = divmod(time_ns - self._grid, self.step_ns)
        self.removed += self._advance(self._model, self._drive, self._grid - self._origin,
                                      self.step_ns, steps, self._state, self._memory)
        self.steps += steps
        self._grid += steps * self.step_ns
        state = self._state.copy()
        if rest:
            self._advance(self._model, self._drive, self._grid - self._origin, rest, 1, state,
                          self._memory)
        return state

    @property
    def counts(self):
        """Return what was counted, as in adaptive: steps, and nothing else."""
        return np.array([self.steps, 0, 0, 0])

    def prepare(self):
        """Do nothing: the kernel is ready."""

    def reset(self):
        """Forget all: the next beginning is the first one."""
        self.removed = 0.0
        self.steps = 0

    def fill(self, first_ns, period_ns, states, limit_ns=None):
        """Write the states at instants that are evenly spaced to states: (n, size)."""
        steps, rest = divmod(period_ns, self.step_ns)
        if rest or steps == 0 or (first_ns - self._grid) % self.step_ns:
            for i, state in enumerate(states):
                state[:] = self.state_at(first_ns + i * period_ns)
            return
        states[0] = self.state_at(first_ns)
        # The others lie on the grid.
        advance, now = self._advance, self._state
        for i in range(1, len(states)):
            self.removed += advance(self._model, self._drive, self._grid - self._origin,
                                    self.step_ns, steps, now, self._memory)
            self._grid += period_ns
            states[i] = now
        self.steps += steps * (len(states) - 1)

    # A step that is cut short is the shorter step that state_at takes.
    cut = end_at = state_at
