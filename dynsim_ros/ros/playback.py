# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The time of a recording as it passes while it is played: faster, slower, or held."""

from __future__ import annotations

import threading
import time


class PlaybackTime:
    """
    Maps a steady clock to the time of a bag; pause and resume may come from another thread.

    rate: seconds of the bag per second. changed: is set when a wait should be looked at again.
    """

    def __init__(self, rate: float, paused: bool = False):
        """Start at time 0 of the bag; `restart` sets another one."""
        self.changed = threading.Event()
        self._rate = rate
        self._lock = threading.Lock()
        self._paused = paused
        self._since = time.monotonic_ns()
        self._from_ns = 0

    @property
    def paused(self) -> bool:
        """Tell whether the time is held."""
        return self._paused

    def restart(self, bag_ns: int):
        """Go on from a time in the bag, in ns."""
        with self._lock:
            self._since, self._from_ns = time.monotonic_ns(), bag_ns

    def now_ns(self) -> int:
        """Return the time in the bag, in ns."""
        with self._lock:
            return self._now_ns()

    def seconds_to(self, bag_ns: int) -> float:
        """Return how long to wait for a time in the bag, in s: 0 or less when it has come."""
        with self._lock:
            if self._paused:
                return float('inf')
            return (bag_ns - self._now_ns()) * 1e-9 / self._rate

    def pause(self) -> int:
        """Hold the time; return it in ns."""
        return self._switch(True)

    def resume(self) -> int:
        """Let the time go on; return it in ns."""
        return self._switch(False)

    def _switch(self, paused: bool) -> int:
        """Hold the time or let it go on from where it is."""
        with self._lock:
            now_ns = self._from_ns = self._now_ns()
            self._since = time.monotonic_ns()
            self._paused = paused
        self.changed.set()
        return now_ns

    def _now_ns(self) -> int:
        """Return the time in the bag; the lock is held."""
        if self._paused:
            return self._from_ns
        return self._from_ns + round((time.monotonic_ns() - self._since) * self._rate)
