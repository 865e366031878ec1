# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Calls in a forked process: one that takes too long, or crashes, ends that process only."""

import multiprocessing

TIMEOUT, CRASH = 'timeout', 'crash'


class Forked:
    """
    Runs a function in a forked process, which has all that was imported and compiled before.

    call: takes one argument; it and what it returns are sent through a pipe.
    """

    def __init__(self, call):
        self._call = call
        self._process = None

    def _serve(self, pipe):
        while True:
            pipe.send(self._call(pipe.recv()))

    def ask(self, argument, limit):
        """Return what the call returns, TIMEOUT after limit [s], or CRASH."""
        if self._process is None:
            context = multiprocessing.get_context('fork')
            self._pipe, other = context.Pipe()
            self._process = context.Process(target=self._serve, args=(other,), daemon=True)
            self._process.start()
            other.close()
        self._pipe.send(argument)
        try:
            if self._pipe.poll(limit):
                return self._pipe.recv()
            outcome = TIMEOUT
        except EOFError:
            outcome = CRASH
        self.end()
        return outcome

    def end(self):
        """End the process."""
        if self._process is not None:
            self._process.kill()
            self._process.join()
            self._pipe.close()
            self._process = None
