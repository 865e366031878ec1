# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What was heard of a topic lately."""

from __future__ import annotations

import numpy as np

from .table import Table

# At most so many rows.
_MOST = 60_000


class History:
    """The newest rows of a topic: those of so many seconds, and at most 60 000."""

    def __init__(self, seconds):
        self._seconds = seconds
        self.clear()

    def clear(self):
        """Forget all."""
        self._time = np.zeros(0)
        self._values = np.zeros((0, 0))
        self._first = self._last = 0

    def add(self, time, values):
        """Add rows: times (n,) [s], ascending, and numbers (n, k)."""
        if self._last + len(time) > len(self._time):
            self._make_room(len(time), values.shape[1])
        end = self._last + len(time)
        self._time[self._last:end] = time
        self._values[self._last:end] = values
        self._last = end
        oldest = np.searchsorted(self._time[:end], time[-1] - self._seconds)
        self._first = max(self._first, int(oldest), end - _MOST)

    @property
    def table(self):
        """Return the rows as a Table; it is good until rows are added."""
        rows = slice(self._first, self._last)
        return Table(self._time[rows], self._values[rows])

    def _make_room(self, more, width):
        """Move what is kept to the front of arrays that are twice as long as it."""
        kept = self.table
        count = len(kept.time)
        size = max(1024, 2 * (count + more))
        self._time, self._values = np.zeros(size), np.zeros((size, width))
        if count:
            self._time[:count], self._values[:count] = kept
        self._first, self._last = 0, count
