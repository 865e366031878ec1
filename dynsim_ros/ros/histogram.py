# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Percentiles of a run of any length, in memory of fixed size."""

import numpy as np

from ..physics.jit import formula

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


@formula
def add(duration, tally):
    """Count a duration [ns] that is not below 0 in the tally of a Histogram."""
    tally[_SIZE] = max(tally[_SIZE], duration)
    tally[place(duration)] += 1


class Histogram:
    """
    Counts durations [ns] by size.

    tally: (_SIZE + 1,) int64, how many there are in each part, and the longest one so far;
    compiled code counts there with `add`.
    """

    def __init__(self):
        self.tally = np.zeros(_SIZE + 1, np.int64)

    @property
    def longest(self):
        """Return the longest duration so far [ns]."""
        return int(self.tally[_SIZE])

    def add(self, duration):
        """Count one duration: an integer [ns]; one below 0 as 0."""
        add(min(max(duration, 0), _LONGEST), self.tally)

    def percentile(self, percent):
        """Return a duration that so many per cent are not above [ns]; None if there is none."""
        counts = self.tally[:_SIZE].tolist()
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
