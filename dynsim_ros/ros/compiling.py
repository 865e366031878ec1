# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Kernels that a change of parameters needs, made ready while the run goes on."""

import time

from .context import one_line
from ..scene import SceneError
from ..simulation.rehearsal import Rehearsal

# How often to look what happens meanwhile [s].
_PERIOD = 0.05
# A change that takes longer than this is worth a line in the log [s].
_PATIENCE = 1.0
# A thread that is at its end, and no longer waits for anything, has so long to get there [s].
_FAREWELL = 1.0


class Compiling:
    """
    Makes kernels ready before they are needed, while the run ticks in another thread.

    simulator: Simulator, prepared; log: the node's; is_ending: function that tells whether the
    program is about to end.
    """

    def __init__(self, simulator, log, is_ending):
        self._log, self._is_ending = log, is_ending
        self._ready = {simulator.kernel_kind({})}
        self._rehearsals = []
        self._is_ahead = False

    def prepare(self, simulator, values, meanwhile):
        """
        Return when the kernels for new {name: value} of quantities and settings are ready.

        simulator: Simulator, a copy of the one that runs; meanwhile: called again and again.
        Raises SceneError if they cannot be made ready.
        """
        kind = simulator.kernel_kind(values)
        if kind not in self._ready:
            names = ', '.join(values) or 'the state'
            self._wait(self._begin(simulator, values), names, meanwhile)
            self._ready.add(kind)
        self.was_changed()

    def was_changed(self):
        """Take note that the method may go over to something else than before."""
        self._is_ahead = False

    def prepare_ahead(self, copy):
        """
        Begin to make ready what the method may go over to later on, unless that is done.

        copy: function that returns a copy of the Simulator that runs.
        """
        for rehearsal in [one for one in self._rehearsals if one.is_over()]:
            self._rehearsals.remove(rehearsal)
            if rehearsal.error is not None:
                self._log.warning(f'not compiled ahead: {one_line(rehearsal.error)}')
        if not self._rehearsals and not self._is_ahead:
            self._is_ahead = True
            self._begin(copy(), {}, ahead=True)

    def give_up(self):
        """End what is under way; return whether it has ended."""
        for rehearsal in self._rehearsals:
            rehearsal.give_up()
        limit = time.monotonic() + _FAREWELL
        return all(one.is_over(max(limit - time.monotonic(), 0.0)) for one in self._rehearsals)

    def _begin(self, simulator, values, ahead=False):
        # What is under way would only slow this one down.
        for rehearsal in self._rehearsals:
            rehearsal.give_up()
        self._rehearsals.append(Rehearsal(simulator, values, ahead))
        return self._rehearsals[-1]

    def _wait(self, rehearsal, names, meanwhile):
        since, is_told = time.monotonic(), False
        while not rehearsal.is_over(_PERIOD):
            meanwhile()
            if self._is_ending():
                raise SceneError(f'{names}: not set: the node is about to end')
            if not is_told and time.monotonic() > since + _PATIENCE:
                self._log.info(f'{names}: compiling, once for this machine; then in force')
                is_told = True
        self._rehearsals.remove(rehearsal)
        if rehearsal.error is not None:
            raise SceneError(f'{names}: cannot be compiled: {one_line(rehearsal.error)}')
