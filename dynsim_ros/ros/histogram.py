# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Percentiles of a run of any length, in memory of fixed size."""

# An octave of durations is divided into so many parts: percentiles are good to 1 / 8.
_PARTS = 8
_SIZE = 64 * _PARTS


class Histogram:
    """Counts durations [ns] by size; longest: the longest one so far."""

    def __init__(self):
        self._counts = [0] * _SIZE
        self.longest = 0

    def add(self, duration):
        """Count one duration: an integer [ns]."""
        duration = max(duration, 0)
        self.longest = max(self.longest, duration)
        self._counts[_place(duration)] += 1

    def percentile(self, percent):
        """Return a duration that so many per cent are not above [ns]; None if there is none."""
        left = sum(self._counts) * percent / 100.0
        if left == 0.0:
            return None
        for place, count in enumerate(self._counts):
            left -= count
            if count and left <= 0.0:
                return min(_upper(place), self.longest)
        return self.longest


def _place(duration):
    """Return the number of the part in which a duration is: its leading four bits and its size."""
    shift = max(duration.bit_length() - 4, 0)
    return min(_PARTS * shift + (duration >> shift), _SIZE - 1)


def _upper(place):
    """Return the largest duration that has a place."""
    if place < 2 * _PARTS:
        return place
    shift, leading = place // _PARTS - 1, place % _PARTS + _PARTS
    return ((leading + 1) << shift) - 1
