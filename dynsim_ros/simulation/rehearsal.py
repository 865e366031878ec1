# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Kernels made ready in a thread for what a run is about to do, while the run goes on.

What is not on disk is compiled by a process of its own and then loaded from there: a thread that
compiles holds the interpreter for so long at times that ticks would be missed.
"""

import os
import pickle
import subprocess
import sys
import threading

from .commands import SetValues
from ..physics.jit import kernels_are_kept, NotKeptError, only_loading

_START = ('import pickle, sys; sys.path[:] = pickle.load(sys.stdin.buffer); '
          f'from {__name__} import compile_from_input; compile_from_input()')


class Rehearsal:
    """
    Tries on a copy of a simulator what it is about to do, which leaves the kernels ready.

    simulator: Simulator, copied here and now; values: as in SetValues, may be empty; ahead:
    whether what its method may go over to later on is made ready, too.
    """

    def __init__(self, simulator, values, ahead=False):
        self._job = simulator.copy(), values, ahead
        self._process = None
        self._given_up = False
        # What the thread failed of.
        self.error = None
        self._thread = threading.Thread(target=self._run, name='compiling', daemon=True)
        self._thread.start()

    def is_over(self, seconds=0.0):
        """Return whether all is ready, or has failed, after waiting for so long at most."""
        self._thread.join(seconds)
        return not self._thread.is_alive()

    def give_up(self):
        """Let it end as soon as it can, in its own time."""
        self._given_up = True
        if self._process is not None:
            self._process.kill()

    def _run(self):
        try:
            try:
                with only_loading():
                    _rehearse(*self._job)
            except NotKeptError:
                if kernels_are_kept():
                    self._compile_elsewhere()
                if not self._given_up:
                    _rehearse(*self._job)
        except Exception as error:
            self.error = error

    def _compile_elsewhere(self):
        """Have all compiled in another process; what that fails of is left to do here."""
        try:
            # In a session of its own it is not interrupted from the terminal.
            self._process = subprocess.Popen(
                [sys.executable, '-c', _START], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL, start_new_session=True)
            with self._process as process:
                if self._given_up:
                    process.kill()
                pickle.dump(sys.path, process.stdin)
                pickle.dump(self._job, process.stdin)
                process.stdin.flush()
                process.wait()
        except OSError:
            pass  # it could not be started, or did not read all: it has ended


def _rehearse(simulator, values, ahead):
    simulator = simulator.copy()
    if values:
        simulator.apply(SetValues(values))
    simulator.prepare()
    if ahead:
        simulator.prepare_ahead()


def compile_from_input():
    """Do a pickled job from standard input, at low priority; end when that is closed."""
    job = pickle.load(sys.stdin.buffer)
    os.nice(10)
    threading.Thread(target=_end_with_input, daemon=True).start()
    _rehearse(*job)


def _end_with_input():
    while os.read(sys.stdin.fileno(), 1):
        pass
    os._exit(1)
