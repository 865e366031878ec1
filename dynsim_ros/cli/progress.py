# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A progress bar on a terminal; nothing anywhere else."""

from __future__ import annotations

import shutil
import sys
import time
from typing import TextIO

from .terminal import write

# How often it is drawn at most [s].
_PERIOD = 0.05


class Progress:
    """
    One line at the bottom of a terminal that is drawn again and again.

    Where the stream is no terminal, or `quiet`, it draws nothing and `say` writes plain lines.
    """

    def __init__(self, total: float, *, quiet: bool = False, stream: TextIO | None = None):
        """Draw towards `total` seconds."""
        self._stream = sys.stdout if stream is None else stream
        self._total = total
        self._quiet = quiet
        self._drawing = not quiet and self._stream.isatty()
        self._next = 0.0

    def show(self, done: float, note: str = ''):
        """Draw the bar at `done` seconds, with a note behind it, unless it is quite new."""
        if not self._drawing or time.monotonic() < self._next:
            return
        self._next = time.monotonic() + _PERIOD
        share = min(done / self._total, 1.0) if self._total > 0 else 1.0
        text = f' {share:4.0%}  {done:.1f} of {self._total:.1f} s  {note}'
        width = shutil.get_terminal_size().columns - 1
        bar = max(min(width - len(text) - 2, 40), 0)
        full = round(share * bar)
        line = f'[{"#" * full}{"." * (bar - full)}]{text}' if bar else text.strip()
        write(self._stream, f'\r\x1b[K{line[:width]}')

    def say(self, line: str):
        """Write a line that stays, unless quiet."""
        if self._quiet:
            return
        self.clear()
        write(self._stream, f'{line}\n')

    def clear(self):
        """Take the bar away, before anything else is written."""
        if self._drawing:
            write(self._stream, '\r\x1b[K')
