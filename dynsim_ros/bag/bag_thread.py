# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The thread that writes what waits into a bag, and what it does when the disk does not play."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
import threading
import time

import numpy as np

from .any_processor import use_any_processor
from .backlog import Backlog
from .gap import Gap, MISSING
from .pack_rows import RowPlan
from .syncing import Syncing
from .writer import BagWriter
from ..simulation.rows.kernel import PRESENT

# How often what waits is brought into the file [s]: so much is lost at most of a process that is
# killed. How long it waits for who told the last time that it was to be done, see hurry. And how
# often that is tried where it failed.
_PERIOD, _HURRIED, _RETRY = 0.02, 0.05, 0.2


class BagThread:
    """
    Works a backlog off into a bag; where that fails, again and again.

    writer: BagWriter of the present file; paths: of all files so far; unfinished: of those that
    could not be; error: what went wrong last, in one line, or None; is_failing: whether the bag
    cannot be written now; lost: messages that cannot be written at all; news: (whether it is an
    error, one line), for who has them shown.
    """

    def __init__(self, writer: BagWriter, backlog: Backlog, sync_period: float):
        """Start the thread; sync_period: see Recorder."""
        self.writer = writer
        self.paths = [writer.path]
        self.unfinished: list[Path] = []
        self.error: str | None = None
        self.is_failing = False
        self.lost = 0
        self.news: deque[tuple[bool, str]] = deque()
        # Held while the present file is written.
        self.lock = threading.RLock()
        self.wake = threading.Event()
        self.is_closing = False
        self._plan: RowPlan | None = None
        self._messages_before = 0
        self._written = 0.0
        self._gaps = 0
        self._rejected: Gap | None = None
        self._backlog = backlog
        self._syncing = Syncing(lambda: self.writer, sync_period, self._report)
        self._thread = threading.Thread(target=self._run, name='bag recorder', daemon=True)
        self._thread.start()

    @property
    def messages(self) -> int:
        """Return the number of messages in the bag, what is on its way to the file included."""
        return self._messages_before + self.writer.message_count

    def declare_rows(self, plan: RowPlan):
        """Let ticks with such rows be written, to this file and those that follow it."""
        with self.lock:
            self.writer.declare_rows(plan)
            self._plan = plan

    def end(self):
        """Write what waits, finish the file and end the thread; harmless when repeated."""
        self.is_closing = True
        self.wake.set()
        self._thread.join()

    def hurry(self):
        """Let what waits be written now, if that was not done just before."""
        if time.monotonic() - self._written >= _PERIOD:
            self.wake.set()

    def write(self, stamp_ns: int, messages: Sequence[tuple[int, bytes]]):
        """Write the messages of one instant."""
        before = self.writer.message_count
        try:
            self.writer.write_all(stamp_ns, messages)
        except OSError:
            raise
        except Exception as error:
            self._reject(error, stamp_ns, len(messages) + before - self.writer.message_count)

    def write_rows(self, blocks: np.ndarray, stamps: np.ndarray) -> tuple[int, int]:
        """Write the first of some ticks; return of how many, and how many messages."""
        before = self.writer.message_count
        try:
            ticks = self.writer.write_rows(blocks, stamps)
        except OSError:
            raise
        except Exception as error:
            count = int((blocks[:, self._plan.start] == PRESENT).sum())
            self._reject(error, int(stamps[0]), count)
            return len(blocks), count
        return ticks, self.writer.message_count - before

    def write_gap(self, gap: Gap):
        """Let the bag tell of messages that are not in it."""
        self.writer.flush()
        self.writer.add_metadata(f'{MISSING}{self._gaps + 1}', gap.values())
        self._gaps += 1
        self.news.append((False, f'{self.writer.path}: {gap}'))

    def change_over(self, make: Callable[[], BagWriter]):
        """Finish the present file and go on in the one that `make` returns the writer of."""
        self._tell_of_rejected()
        self.writer.flush()
        following = make()
        if self._plan is not None:
            following.declare_rows(self._plan)
        finished, self.writer = self.writer, following
        self.paths.append(following.path)
        self._messages_before += finished.message_count
        self._gaps = 0
        self._close(finished)

    def _run(self):
        use_any_processor()
        is_told = False
        while not self.is_closing:
            usual = _HURRIED if is_told else _PERIOD
            is_told = self.wake.wait(_RETRY if self.is_failing else usual)
            self.wake.clear()
            self._written = time.monotonic()
            self._write_what_waits()
        if not self._write_what_waits():
            self.lost += self._backlog.drop()
        with suppress(OSError):
            self._tell_of_rejected()
        self._syncing.end()
        self._close(self.writer)

    def _write_what_waits(self) -> bool:
        """Bring what waits into the file; tell whether that could be done."""
        try:
            with self.lock:
                self._backlog.work_off(self.write_rows)
                self.writer.flush()
        except OSError as error:
            if not self.is_failing:
                self._report(f'{error.filename or self.writer.path} cannot be written: '
                             f'{error.strerror or error}')
            self.is_failing = True
        else:
            if self.is_failing:
                self.news.append((False, f'{self.writer.path} is written again'))
            self.is_failing = False
        return not self.is_failing

    def _close(self, writer):
        """Finish a file and close it."""
        before = writer.message_count
        with self._syncing.lock:
            try:
                writer.close(self._syncing.period > 0.0)
            except OSError as error:
                self.unfinished.append(writer.path)
                line = f'{writer.path} is not finished: {error.strerror or error}'
                self.news.append((True, f'{line}; recover it when there is room'))
                self.error = self.error or line
        self.lost += before - writer.message_count

    def _reject(self, error, stamp_ns, count):
        """Count messages that no bag can hold."""
        if self._rejected is None:
            self._rejected = Gap(str(error) or type(error).__name__, stamp_ns)
            self._report(self._rejected.reason)
        self._rejected.add(stamp_ns, count)
        self.lost += count

    def _tell_of_rejected(self):
        """Let the bag tell of these."""
        if self._rejected is not None:
            self.write_gap(self._rejected)
            self._rejected = None

    def _report(self, line):
        self.error = line
        self.news.append((True, line))
