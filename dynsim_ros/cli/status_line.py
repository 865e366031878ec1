# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A line of status that is drawn again and again on a terminal, and now and then elsewhere."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
import shutil
import sys
import threading
import time

from .terminal import write

_TERMINAL_PERIOD, _PLAIN_PERIOD = 0.1, 1.0


class StatusLine:
    """
    Shows one line on standard output; on a terminal in place, elsewhere as plain lines.

    enabled: False to show nothing.
    """

    def __init__(self, enabled=True):
        self.enabled = enabled
        self._in_place = sys.stdout.isatty()
        self._drawn = False
        self._next = 0.0
        self._lock = threading.RLock()

    def is_due(self) -> bool:
        """Tell whether it is time to show the line again."""
        return self.enabled and time.monotonic() >= self._next

    def show(self, text: str):
        """Show the line now."""
        if not self.enabled:
            return
        self._next = time.monotonic() + (_TERMINAL_PERIOD if self._in_place else _PLAIN_PERIOD)
        if self._in_place:
            width = shutil.get_terminal_size().columns - 1
            with self._lock:
                write(sys.stdout, f'\r\x1b[K{text[:width]}')
                self._drawn = True
        else:
            write(sys.stdout, f'{text}\n')

    @contextmanager
    def aside(self) -> Iterator[None]:
        """Keep the line away while something else is written; from any thread."""
        with self._lock:
            if self._drawn:
                write(sys.stdout, '\r\x1b[K')
                self._drawn = False
            yield

    def end(self):
        """Leave the line as it is and go on below it."""
        if self._drawn:
            write(sys.stdout, '\n')
            self._drawn = False
