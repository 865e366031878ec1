# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A motion from its start, without commands: the shortest way from a scene to its states."""

from dataclasses import replace

import numpy as np

from .settings import SECOND, Settings
from ..integrators import new_steps
from ..physics.drive import undisturbed_drive
from ..physics.model import build_model
from ..physics.state import initial_state


class Propagator:
    """
    Computes states of a scene that nobody touches; works are not counted.

    scene: Scene; budget: the most steps that an error-controlled method may attempt in one call;
    changes: fields of Settings (integrator, tolerance, step). For runs with commands, energies and
    forces there is Simulator.
    """

    def __init__(self, scene, budget=10_000_000, **changes):
        self.settings = replace(Settings(), **changes)
        self._model = build_model(scene)
        self._start = initial_state(scene, self._model)
        self._steps = new_steps(self.settings, self._model, undisturbed_drive(scene),
                                len(self._start))
        self._steps.budget = budget

    def _begin(self):
        self._steps.reset()
        self._steps.begin(0, self._start)

    @property
    def counts(self):
        """Return {'steps', 'rejected', 'evaluations', 'rounded'} of the last run."""
        return dict(zip(('steps', 'rejected', 'evaluations', 'rounded'),
                        map(int, self._steps.counts)))

    @property
    def shortfall(self):
        """Return, in words, what keeps the method from its tolerance; None where nothing does."""
        return self._steps.shortfall

    def end_state(self, duration):
        """Return the state after a duration [s]: (size,), laid out as in physics.state."""
        self._begin()
        return self._steps.end_at(round(duration * SECOND))

    def samples(self, duration, rate):
        """Return (n, size) states at 0, 1 / rate, 2 / rate, … up to a duration [s]; rate: [Hz]."""
        self._begin()
        period = round(SECOND / rate)
        states = np.zeros((round(duration * SECOND) // period + 1, len(self._start)))
        states[0] = self._start
        self._steps.fill(period, period, states[1:])
        return states
