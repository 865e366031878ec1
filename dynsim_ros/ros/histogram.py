# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Percentiles of a run of any length, in memory of fixed size."""

import numpy as np

from ..integrators.entry import entry
from ..physics.jit import formula, kernel

# An octave of durations is divided into so many parts: percentiles are good to 1 / 8.
_PARTS = 8
_SIZE = 64 * _PARTS
# The longest duration that is told from longer ones [ns]: three hundred years.
_LONGEST = 2 ** 63 - 1


@formula
def place(duration):
    """Return the number of the part in which a duration is: its leading four bits and its size."""
    shift = 0
    while duration >> shift >= 2 * _PARTS:
        shift += 1
    return _PARTS * shift + (duration >> shift)


@kernel
def _count(durations, counts):
    """Count durations: (n,) int64, none below 0, in counts: (_SIZE,) int64."""
    for duration in durations:
        counts[place(duration)] += 1


class Histogram:
    """Counts durations [ns] by size; longest: the longest one so far."""

    def __init__(self):
        self._counts = np.zeros(_SIZE, np.int64)
        self._count = entry(_count, self._counts, self._counts)
        self.longest = 0

    def add(self, duration):
        """Count one duration: an integer [ns]."""
        duration = max(duration, 0)
        self.longest = max(self.longest, duration)
        self._counts[place(min(duration, _LONGEST))] += 1

    def add_all(self, durations):
        """Count durations, one at least, none below 0: (n,) int64."""
        self.longest = max(self.longest, int(durations.max()))
        self._count(durations, self._counts)

    def percentile(self, percent):
        """Return a duration that so many per cent are not above [ns]; None if there is none."""
        counts = self._counts.tolist()
        left = sum(counts) * percent / 100.0
        if left == 0.0:
            return None
        for number, count in enumerate(counts):
            left -= count
            if count and left <= 0.0:
                return min(_upper(number), self.longest)
        return self.longest


def _upper(number):
    """Return the largest duration that is in a part."""
    if number < 2 * _PARTS:
        return number
    shift, leading = number // _PARTS - 1, number % _PARTS + _PARTS
    return ((leading + 1) << shift) - 1
