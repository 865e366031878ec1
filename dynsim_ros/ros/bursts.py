# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Ticks that follow each other without the interpreter: compiled code waits for them and publishes.

The states at the next ticks are often known, or the step that gives them can be taken now: see
Simulator.step_ahead. Their messages are built in one go; what is left to be done at each tick is
to wake up and to send. Neither the interpreter nor its lock, whoever holds that, is needed for it.
Where nobody listens and all is recorded, there is nothing to do until the last of them: they are
run in one go then.
"""

import time

import numpy as np

from .calling import call
from .histogram import add
from .pacing import SECOND
from .sending import no_rows, publish_block, Together
from ..integrators.entry import entry
from ..physics.jit import formula, kernel
from ..simulation.simulator import MOST_AHEAD

# So long ticks are at most [ns]: who asks for something waits for the end of one.
_LONGEST_TICK = 2_000_000
# So long a burst lasts at most that is recorded [ns]: what is to be recorded waits until then. The
# second is for those that nobody listens to, which end where markers are due.
_LONGEST_RECORDED, _LONGEST_UNHEARD = 15_000_000, 40_000_000
# After something else had to be done, as a command, less is built that may be of no use.
_FEW = 8
# Ticks that are later than this are left to who can give them up [ns].
_PATIENCE = 5_000_000
_MONOTONIC = time.CLOCK_MONOTONIC


@formula
def _wait(sleep, clock, alarm, semaphore, instant, deadline, spin):
    """
    Wait until a deadline of the steady clock [ns] or until an Alarm rings; return what time it is.

    sleep, clock, alarm, semaphore: functions, flag and semaphore of the Alarm; instant: (3,) a
    timespec and its address; spin: how long before the deadline to wait busily [ns].
    """
    now = 0
    while now < deadline:
        call(clock, (_MONOTONIC, instant[2]))
        now = instant[0] * SECOND + instant[1]
        if alarm[0] != 0:
            break
        wake = deadline - spin
        if now < wake:
            instant[0], instant[1] = wake // SECOND, wake % SECOND
            call(sleep, (semaphore, _MONOTONIC, instant[2]))
    return now


@kernel
def _tick_on(sleep, clock, alarm, semaphore, instant, deadlines, spin, period, lateness, spent,
             rows):
    """
    Publish block k of rows at deadline k of the steady clock [ns]; return how many were.

    Where nobody listens, all are left to the last deadline. An alarm ends it before the next tick.
    For most arguments see _wait. period: how long a tick takes [ns]; lateness: tally of a
    Histogram; spent: (2,) receives how long publishing took [ns], and how many of the ticks were
    late by a tick or more.
    """
    count = deadlines.shape[0]
    spent[:] = 0
    if rows.publishers.shape[0] == 0:
        now = _wait(sleep, clock, alarm, semaphore, instant, deadlines[count - 1], spin)
        for k in range(count):
            if deadlines[k] > now:
                return k
            add(now - deadlines[k] if k == count - 1 else 0, lateness)
        return count
    for k in range(count):
        now = _wait(sleep, clock, alarm, semaphore, instant, deadlines[k], spin)
        if alarm[0] != 0:
            return k
        late = now - deadlines[k]
        if late > _PATIENCE or publish_block(rows, k) < rows.publishers.shape[0]:
            return k
        add(late, lateness)
        call(clock, (_MONOTONIC, instant[2]))
        spent[0] += instant[0] * SECOND + instant[1] - now
        spent[1] += late >= period
    return count


class Bursts:
    """
    Lets a Run tick on in this way for as long as all that it needs is known.

    pacer: Pacer; mailbox: Mailbox, whose letters end a burst; lateness: Histogram; spin: [s].
    is_possible: whether it can be done at all here.
    """

    def __init__(self, run, pacer, mailbox, lateness, spin):
        self._run, self._pacer, self._mailbox, self._lateness = run, pacer, mailbox, lateness
        self._spin = round(spin * SECOND)
        self._most = _FEW
        self._spent = np.zeros(2, np.int64)
        self._instant = np.zeros(3, np.int64)
        self._instant[2] = self._instant.ctypes.data
        self._tick_on, self._nothing = None, no_rows()

    @property
    def period(self):
        """Return how long a tick takes [ns], None where that is too long or not known."""
        pacer = self._pacer
        if not (pacer.is_steady and pacer.factor > 0.0):
            return None
        period = self._run.simulator.settings.tick_ns / pacer.factor
        return period if period <= _LONGEST_TICK else None

    def go(self):
        """Run ticks in this way before anything else is to be done; return how many could be."""
        period = self.period
        if (period is None or self._mailbox.alarm.functions is None
                or self._is_too_late(period)):
            return 0
        run = self._run
        stretch = run.stretch(MOST_AHEAD)
        if stretch is None:
            return 0
        if not stretch.due.is_heard:
            # Recorded, then: else it would not be wanted.
            stretch = stretch.first(int(_LONGEST_UNHEARD / period))
            return self._pass(stretch, period) if self._mailbox.is_quiet() else 0
        most = self._most
        if run.bag is not None:
            most = min(most, int(_LONGEST_RECORDED / period))
        stretch = run.known_of(stretch, most)
        if (stretch is None or not isinstance(stretch.due.send, Together)
                or not self._mailbox.is_quiet()):
            return 0
        return self._tick(stretch, period)

    def _pass(self, stretch, period):
        """Run the ticks of a Stretch that nobody listens to, when all are due or until woken."""
        run, pacer = self._run, self._pacer
        deadlines = pacer.deadlines(run.simulator.time_ns, run.simulator.settings.tick_ns,
                                    stretch.count)
        due = self._wait(deadlines, period, self._nothing)
        done = run.pass_by(stretch, due) if due else 0
        if done:
            pacer.is_up_to_date()
        return done

    def _wait(self, deadlines, period, rows):
        """Let compiled code run to deadlines; see _tick_on."""
        if self._tick_on is None:
            self._tick_on = prepare_bursts()
        alarm = self._mailbox.alarm
        return self._tick_on(*alarm.functions, alarm.flag, alarm.semaphore, self._instant,
                             deadlines, self._spin, int(period), self._lateness.tally,
                             self._spent, rows)

    def _is_too_late(self, period):
        """Tell whether the next tick is, one that comes after so long [ns]."""
        pacer = self._pacer
        return pacer.now() - pacer.deadline(self._run.simulator.time_ns) > period + _PATIENCE

    def _tick(self, stretch, period):
        """Run the ticks of a Stretch, as far as nothing ends it; return how many were run."""
        run, pacer, count = self._run, self._pacer, stretch.count
        begin = time.monotonic_ns()
        run.build_ahead(stretch)
        deadlines = pacer.deadlines(run.simulator.time_ns, run.simulator.settings.tick_ns, count)
        built = time.monotonic_ns()
        done = self._wait(deadlines, period, stretch.due.send.rows)
        self._most = min(2 * self._most, MOST_AHEAD) if done == count else _FEW
        if done:
            run.was_published(stretch, done)
            pacer.is_up_to_date()
            pacer.late += int(self._spent[1])
        run.work['publish'] += built - begin + int(self._spent[0])
        return done


def prepare_bursts():
    """Compile, or load from the disk cache, the kernel; return it, see entry."""
    numbers = np.zeros(3, np.int64)
    return entry(_tick_on, 0, 0, numbers, 0, numbers, numbers, 0, 0, numbers, numbers, no_rows())
