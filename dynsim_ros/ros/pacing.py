# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How many ticks of simulated time are due, by a clock that may be late."""

import math
import time

import numpy as np

SECOND = 1_000_000_000
# Ticks that are late by more than this much real time are given up and counted as missed.
LONGEST_LAG = SECOND // 5
# The same where the clock is another's: that may tick slowly, but what it says has passed.
LONGEST_STRIDE = 10 * SECOND
# A run that nobody waits for comes up to date at least so often.
LONGEST_PERIOD = SECOND
# Real seconds that fit into the longest run: keeps a tiny real-time factor from overflowing.
_LONGEST = 10 ** 18


class Pacer:
    """
    Ties simulated time to a clock: each tick has an absolute deadline.

    factor: simulated seconds per second of the clock, 0 for as fast as possible; now: function
    that returns the clock's time [ns]; longest_lag: what is made up for at most [ns of the
    clock]. is_steady: whether that clock is the steady one of the operating system; missed: ticks
    given up; late: ticks that were run when the next one was already due.
    """

    def __init__(self, factor, now=time.monotonic_ns):
        self.factor = factor
        self.now = now
        self.is_steady = now is time.monotonic_ns
        self.longest_lag = LONGEST_LAG
        self.missed = 0
        self.late = 0
        self.restart(0)

    def restart(self, time_ns):
        """Let the simulated time time_ns be now."""
        self._clock_start = self.now()
        self._time_start = time_ns
        self.is_up_to_date()

    def is_up_to_date(self):
        """Take note that all ticks that were due have been run."""
        self._latest = self.now() + LONGEST_PERIOD

    def ticks_until(self, instant, time_ns, tick_ns):
        """Return how many ticks after simulated time time_ns are due by an instant [ns]."""
        passed = self._time_start + int((instant - self._clock_start) * self.factor)
        return max((passed - time_ns) // tick_ns, 0)

    def deadline(self, time_ns):
        """Return the time of the clock at which a simulated time is due, at factors above 0."""
        real = min((time_ns - self._time_start) / self.factor, _LONGEST)
        return self._clock_start + math.ceil(real)

    def deadlines(self, time_ns, tick_ns, count):
        """Return those of so many ticks that follow a simulated time: (count,) int64."""
        times = time_ns - self._time_start + tick_ns * np.arange(1, count + 1)
        real = np.minimum(times / self.factor, _LONGEST)
        return self._clock_start + np.ceil(real).astype(np.int64)

    def due(self, time_ns, tick_ns, wanted):
        """
        Return (number of ticks to run now, how long there is nothing to do [ns of the clock]).

        wanted: how many ticks it is from time_ns to one that somebody waits for; those before it
        are not run on their own. What is late beyond longest_lag is given up.
        """
        if self.factor == 0.0:
            return wanted, 0
        now = self.now()
        lag = self._give_up(now, time_ns, tick_ns, wanted)
        if lag < 0:
            return 0, -lag
        due = self.ticks_until(now, time_ns, tick_ns)
        if due == 0:
            self.is_up_to_date()
        return due, 0

    def left(self, time_ns, tick_ns, wanted):
        """Return how long there is nothing to do [ns of the clock] where nothing is due now."""
        if self.factor == 0.0:
            return 0
        return max(min(self.deadline(time_ns + wanted * tick_ns), self._latest) - self.now(), 0)

    def due_before(self, instant, time_ns, tick_ns, wanted):
        """
        Return how many ticks are due by an instant, not after now [ns of the clock].

        What is late by now is given up as in `due`, whose arguments the others are.
        """
        if self.factor == 0.0:
            return 0
        now = self.now()
        self._give_up(now, time_ns, tick_ns, wanted)
        return self.ticks_until(min(instant, now), time_ns, tick_ns)

    def _give_up(self, now, time_ns, tick_ns, wanted):
        """Give up the ticks that are too late; return how late what is wanted was [ns]."""
        lag = now - min(self.deadline(time_ns + wanted * tick_ns), self._latest)
        if lag > self.longest_lag:
            excess = int((lag - self.longest_lag) * self.factor) // tick_ns
            self.missed += excess
            self._time_start -= excess * tick_ns
        return lag
