# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A thread that has what was written brought to the disk, so that a power failure costs little."""

from __future__ import annotations

from collections.abc import Callable
import threading

from .any_processor import use_any_processor
from .output import sync_folder
from .writer import BagWriter


class Syncing:
    """
    Brings a bag to the disk again and again, while another thread goes on writing it.

    period: how often [s], 0: never; lock: to be held by who closes the writer.
    """

    def __init__(self, writer: Callable[[], BagWriter], period: float,
                 report: Callable[[str], None]):
        """
        Start the thread.

        writer: returns the writer of the present file; report: takes a line about what went wrong.
        """
        self.period = period
        self.lock = threading.Lock()
        self._writer, self._report = writer, report
        self._is_failing = False
        self._known: BagWriter | None = None
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name='bag sync', daemon=True)
        if period > 0.0:
            self._thread.start()

    def end(self):
        """End the thread."""
        self._ending.set()
        if self.period > 0.0:
            self._thread.join()

    def _run(self):
        use_any_processor()
        while not self._ending.wait(self.period):
            with self.lock:
                writer = self._writer()
                try:
                    self._sync(writer)
                except OSError as error:
                    if not self._is_failing:
                        self._report(f'{writer.path} cannot be brought to the disk: '
                                     f'{error.strerror or error}')
                    self._is_failing = True
                else:
                    self._is_failing = False

    def _sync(self, writer):
        writer.sync()
        if writer is not self._known:
            sync_folder(writer.path.parent)
            self._known = writer
