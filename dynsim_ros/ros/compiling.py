# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Kernels that a change of parameters needs, made ready while the run goes on."""

import time

from .context import one_line
from ..scene import SceneError
from ..simulation.rehearsal import Rehearsal

# A change that takes longer than this is worth a line in the log [s].
_PATIENCE = 1.0
# A thread that is at its end, and no longer waits for anything, has so long to get there [s].
_FAREWELL = 1.0


class Compiling:
    """
    Makes kernels ready before they are needed.

    run: Run, prepared; log: the node's; is_ending: function that tells whether the program is
    about to end.
    """

    def __init__(self, run, log, is_ending):
        self._run, self._log, self._is_ending = run, log, is_ending
        self._ready = {run.simulator.kernel_kind({})}
        self._rehearsals = []
        self._is_ahead = False

    def prepare(self, values, go_on):
        """
        Return when the kernels for new {name: value} of quantities and settings are ready.

        go_on: called again and again meanwhile: lets the run go on and returns how long there is
        nothing to do [s]. Raises SceneError if they cannot be made ready.
        """
        if not values:
            return
        kind = self._run.simulator.kernel_kind(values)
        if kind not in self._ready:
            self._wait(self._begin(values), ', '.join(values), go_on)
            self._ready.add(kind)
        self.was_changed()

    def was_changed(self):
        """Take note that the method may go over to something else than before."""
        self._is_ahead = False

    def prepare_ahead(self):
        """Begin to make ready what the method may go over to later on, unless that is done."""
        for rehearsal in [one for one in self._rehearsals if one.is_over()]:
            self._rehearsals.remove(rehearsal)
            if rehearsal.error is not None:
                self._log.warning(f'not compiled ahead: {one_line(rehearsal.error)}')
        if not self._rehearsals and not self._is_ahead:
            self._is_ahead = True
            self._begin({}, ahead=True)

    def give_up(self):
        """End what is under way; return whether it has ended."""
        for rehearsal in self._rehearsals:
            rehearsal.give_up()
        limit = time.monotonic() + _FAREWELL
        return all(one.is_over(max(limit - time.monotonic(), 0.0)) for one in self._rehearsals)

    def _begin(self, values, ahead=False):
        # What is under way would only slow this one down.
        for rehearsal in self._rehearsals:
            rehearsal.give_up()
        self._rehearsals.append(Rehearsal(self._run.simulator, values, ahead))
        return self._rehearsals[-1]

    def _wait(self, rehearsal, names, go_on):
        since, is_told = time.monotonic(), False
        while not rehearsal.is_over(go_on()):
            if self._is_ending():
                raise SceneError(f'{names}: not set: the node is about to end')
            if not is_told and time.monotonic() > since + _PATIENCE:
                self._log.info(f'{names}: compiling, once for this machine; then in force')
                is_told = True
        self._rehearsals.remove(rehearsal)
        if rehearsal.error is not None:
            raise SceneError(f'{names}: cannot be compiled: {one_line(rehearsal.error)}')
