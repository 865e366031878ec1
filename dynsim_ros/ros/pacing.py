# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How many ticks of simulated time are due, by a clock that may be late."""

from itertools import count
import math
import time

SECOND = 1_000_000_000
# Ticks that are late by more than this much real time are given up and counted as missed.
LONGEST_LAG = SECOND // 5
# The same where the clock is another's: that may tick slowly, but what it says has passed.
LONGEST_STRIDE = 10 * SECOND
# A timer is asked at least so often.
LONGEST_PERIOD = SECOND
# A timer is never asked for more calls a second than this; it then runs several ticks a call.
SHORTEST_PERIOD = SECOND // 2000
# How long ticks may run before commands get their turn.
BATCH = SECOND // 200


class Pacer:
    """
    Ties simulated time to a clock.

    factor: simulated seconds per second of the clock, 0 for as fast as possible; now: function
    that returns the clock's time [ns]; longest_lag: what is made up for at most [ns of the
    clock]. missed: ticks given up; late: ticks made up for.
    """

    def __init__(self, factor, now=time.monotonic_ns):
        self.factor = factor
        self.now = now
        self.longest_lag = LONGEST_LAG
        self.missed = 0
        self.late = 0
        self.restart(0)

    def restart(self, time_ns):
        """Let the simulated time time_ns be now."""
        self._clock_start = self.now()
        self._time_start = time_ns

    def period(self, tick_ns):
        """Return how often to ask what is due [ns of the clock]."""
        if self.factor == 0.0:
            return SHORTEST_PERIOD
        return round(min(max(tick_ns / self.factor, SHORTEST_PERIOD), LONGEST_PERIOD))

    def time_left(self, time_ns, tick_ns):
        """Return how long it is until the tick after time_ns is due [s], a period at most."""
        left = 0.0
        if self.factor > 0.0:
            elapsed = self.now() - self._clock_start
            left = (time_ns + tick_ns - self._time_start) / self.factor - elapsed
        return min(max(left, 0.0), self.period(tick_ns)) / SECOND

    def ticks_due(self, time_ns, tick_ns):
        """
        Yield once for each tick that is due at simulated time time_ns, for at most BATCH.

        The caller advances time by tick_ns each time round. What there is no time for stays due.
        """
        end = time.monotonic_ns() + BATCH
        due, usual = self._count_due(time_ns, tick_ns)
        for number in count() if self.factor == 0.0 else range(due):
            self.late += number >= usual
            yield
            if time.monotonic_ns() >= end:
                return

    def _count_due(self, time_ns, tick_ns):
        """Return how many ticks are due, and how many are when the clock is asked in time."""
        if self.factor == 0.0:
            return math.inf, math.inf
        elapsed = self.now() - self._clock_start
        due = int(self._time_start + elapsed * self.factor - time_ns) // tick_ns
        usual = max(round(self.period(tick_ns) * self.factor / tick_ns), 1)
        most = max(int(self.longest_lag * self.factor) // tick_ns, usual)
        if due > most:
            self.missed += due - most
            self._time_start -= (due - most) * tick_ns
            due = most
        return due, usual
