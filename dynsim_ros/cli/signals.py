# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a program does when it is asked to end: Ctrl-C, SIGTERM, a terminal that is closed."""

from __future__ import annotations

from collections.abc import Callable
import signal
import sys

_ALL = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Interrupted(BaseException):
    """
    The program was asked to end before it had begun.

    Not a KeyboardInterrupt: once one of those has gone through an exec(), as imports have them,
    Python ends itself by SIGINT, although the exception was caught.
    """


class Signals:
    """
    Takes over the signals that ask a program to end.

    First they raise Interrupted, so that whatever takes long at the start ends at once.
    From `hold` on they are noted in `requested` only, so that what is being published and
    recorded is finished, however often one asks.
    """

    def __init__(self):
        """Take over the signals of this process."""
        self.requested = False
        # A signal that comes before the program is run is noted.
        self._holding = True
        # Within a callback from C, Python reports an exception and drops it.
        report = sys.unraisablehook
        sys.unraisablehook = lambda dropped: (
            None if isinstance(dropped.exc_value, Interrupted) else report(dropped))
        for number in _ALL:
            # A program started with nohup or in the background is not to be ended by these.
            if signal.getsignal(number) != signal.SIG_IGN or number == signal.SIGTERM:
                signal.signal(number, self._handle)

    def run(self, program: Callable[[], int], stopped: int = 0) -> int:
        """Run a program and return its exit status, or `stopped` if it was ended at its start."""
        try:
            self._holding = False
            if self.requested:
                raise Interrupted
            return program()
        except Interrupted:
            return stopped
        except Exception:
            # What a module or a compiler written in C makes of an Interrupted: an ImportError,
            # a RuntimeError.
            if self.requested and not self._holding:
                return stopped
            raise

    def hold(self):
        """Let a signal be noted, from here on; raise Interrupted if one was dropped before."""
        if self.requested:
            raise Interrupted
        self._holding = True

    def is_requested(self) -> bool:
        """Tell whether the program was asked to end."""
        return self.requested

    def ignore(self):
        """Let the program end as it is about to, the last act of it."""
        self._holding = True
        # Of a signal that comes between its old handler and the new one, Python reports that.
        sys.unraisablehook = lambda dropped: None
        for number in _ALL:
            signal.signal(number, signal.SIG_IGN)

    def _handle(self, *_):
        self.requested = True
        if not self._holding:
            raise Interrupted
