# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A motion that is not integrated, because it has a closed form."""

import numpy as np

from .adaptive import COUNTS_SIZE
from .closed_scene import AT_REST, evaluate, Recogniser
from .entry import entry


class ClosedMotion:
    """
    Gives the states of a motion in closed form; used as FixedSteps is.

    model: Model; drive: Drive. Each state is computed from that at the beginning: it depends on
    nothing else, and costs the same whenever it is.
    """

    shortfall = None
    removed = 0.0

    def __init__(self, model, drive):
        self._recogniser = Recogniser(model, drive)
        self._evaluate = {}

    @property
    def counts(self):
        """Return what was counted, as in adaptive: nothing."""
        return np.zeros(COUNTS_SIZE, dtype=np.int64)

    def begin(self, time_ns, state):
        """Begin at an instant [ns], in a state: (size,); return whether there is a closed form."""
        self._origin = time_ns
        self._scene = self._recogniser.closed_scene(state)
        return self._scene is not None

    def fill(self, first_ns, period_ns, states, limit_ns=None):
        """Write the states at instants that are evenly spaced to states: (n, size)."""
        # All else in a scene is of the same type whenever its motion begins.
        kind = tuple([part is None for part in self._scene])
        if kind == AT_REST:
            states[:] = self._scene.start
            return
        arguments = self._scene, first_ns - self._origin, period_ns, states
        if kind not in self._evaluate:
            self._evaluate[kind] = entry(evaluate, *arguments)
        self._evaluate[kind](*arguments)

    def state_at(self, time_ns, limit_ns=None):
        """Return the state at any instant."""
        states = np.empty((1, len(self._scene.start)))
        self.fill(time_ns, 1, states)
        return states[0]

    end_at = cut = state_at

    def prepare(self):
        """Compile, or load from the cache, what is needed."""
        self.fill(self._origin, 1, np.empty((0, len(self._scene.start))))

    def reset(self):
        """Do nothing: nothing is kept."""
