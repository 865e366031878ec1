# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The choice between closed forms and steps: from each beginning on, whichever is possible."""

from .closed_motion import ClosedMotion


class AutoMotion:
    """
    Advances a state in closed form where it can be, else in steps; used as either.

    new_steps: returns the AutoSteps of the model; called, and compiled, when first needed; budget:
    see Walk, None for the usual one.
    """

    budget = None

    def __init__(self, model, drive, new_steps):
        self._new_steps = new_steps
        self._closed, self._steps = ClosedMotion(model, drive), None
        self._current = self._closed
        # Commands can take every other motion out of its closed form.
        self._stays_closed = model.springs is None and model.rigid == 0

    @property
    def counts(self):
        """Return what was counted, as in adaptive."""
        return self._closed.counts if self._steps is None else self._steps.counts

    @property
    def removed(self):
        """Return the sum of what normalising the quaternions removed."""
        return self._current.removed

    @property
    def shortfall(self):
        """Return, in words, by how much rounding exceeds the tolerance; None if it does not."""
        return self._current.shortfall

    def _all_steps(self):
        if self._steps is None:
            self._steps = self._new_steps()
            if self.budget is not None:
                self._steps.budget = self.budget
        return self._steps

    def begin(self, time_ns, state):
        """Begin at an instant [ns], in a state: (size,)."""
        self._current = self._closed
        if not self._closed.begin(time_ns, state):
            self._current = self._all_steps()
            self._current.begin(time_ns, state)

    def state_at(self, time_ns, limit_ns=None):
        """Return the state at an instant that is not before the last one asked for."""
        return self._current.state_at(time_ns, limit_ns)

    def fill(self, first_ns, period_ns, states, limit_ns=None):
        """Write the states at instants that are evenly spaced to states: (n, size)."""
        self._current.fill(first_ns, period_ns, states, limit_ns)

    def end_at(self, time_ns):
        """Return the state at an instant at which a step, if there are any, ends."""
        return self._current.end_at(time_ns)

    def cut(self, time_ns):
        """Return the state at an instant; a step that has gone past it is taken back to it."""
        return self._current.cut(time_ns)

    def prepare(self):
        """Compile, or load from the cache, what is needed, also after commands, or do nothing."""
        self._current.prepare()
        if self._current is self._closed and not self._stays_closed:
            self._all_steps().prepare()

    def prepare_ahead(self, state):
        """Compile, or load from the cache, what may be needed later on, from a state (size,)."""
        if not self._stays_closed:
            self._all_steps().prepare_ahead(state)

    def reset(self):
        """Forget all: the next beginning is the first one."""
        if self._steps is not None:
            self._steps.reset()
