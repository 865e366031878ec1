# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The thread in which a run ticks, to absolute deadlines."""

import threading
import time

from .bursts import Bursts
from .histogram import Histogram
from .inbox import Mailbox
from .pacing import LONGEST_LAG, LONGEST_PERIOD, SECOND
from .real_time import (be_first, end_timer_slack, lock_memory, Precedence, stay_on,
                        take_short_turns)

# How long ticks may run before commands get their turn.
BATCH = SECOND // 200
# Ticks that nobody waits for are run in one go, as many as take about so long.
_GO = SECOND // 1000
_MOST_IN_ONE_GO = 1024


class Ticker:
    """
    Runs the ticks that are due, and at tick boundaries what the mailbox holds.

    A command takes effect at the last tick boundary before it arrived, however late the thread
    is. Where ticks are quick the next one, which shows it, comes at once, up to a tick early. What
    nobody waits for is not run tick by tick, but in one go when somebody asks; the thread sleeps
    meanwhile. is_ready: function that tells whether the clock runs. error: what the thread failed
    of, None as long as it has not. options: dict of the node's own parameters; warn: takes a line
    about what of them is not granted.
    lateness: Histogram of how long after their deadlines ticks began [ns].
    """

    def __init__(self, run, pacer, is_ready, options, warn):
        self.mailbox = Mailbox(lambda: pacer.now())
        self.error = None
        self._run, self._pacer, self._is_ready = run, pacer, is_ready
        self.lateness = Histogram()
        self._options, self._warn = options, warn
        self._spin = options['real_time.spin']
        self._precedence = Precedence(options['real_time.priority'] < 0.0)
        self._bursts = Bursts(run, pacer, self.mailbox, self.lateness, self._spin)
        self._ticks_in_one_go = 1
        self._is_ending = False
        self._thread = threading.Thread(target=self._work, name='ticks', daemon=True)

    def begin(self):
        """Start the thread."""
        self._pacer.restart(self._run.simulator.time_ns)
        self.mailbox.begin(self._thread)
        self._thread.start()

    def end(self):
        """End the thread; what it was told before is done."""
        self._is_ending = True
        self.mailbox.wake()
        if self._thread.is_alive():
            self._thread.join()

    def _work(self):
        try:
            self._ask_for_real_time()
            while not self._is_ending:
                self.mailbox.hush()
                if self._carry_out():
                    self._show()
                if self._bursts.go():
                    self._precedence.take_or_give_back()
                else:
                    seconds = self._turn()
                    if seconds > self._spin:
                        self.mailbox.wait(seconds - self._spin)
        except BaseException as error:
            self.error = error
        finally:
            self.mailbox.end()

    def _ask_for_real_time(self):
        end_timer_slack()
        take_short_turns()
        options, refusals = self._options, []
        if options['real_time.cpu'] >= 0.0:
            refusals.append(stay_on(int(options['real_time.cpu'])))
        if options['real_time.priority'] >= 1.0:
            refusals.append(be_first(int(options['real_time.priority'])))
        if options['real_time.lock_memory']:
            refusals.append(lock_memory())
        for line in filter(None, refusals):
            self._warn(line)

    def _turn(self):
        """Do what is due; return how long there is nothing to do [s]."""
        if not self._goes_on():
            return LONGEST_PERIOD / SECOND
        simulator, wanted = self._run.simulator, self._run.ticks_to_wanted()
        due, left = self._pacer.due(simulator.time_ns, simulator.settings.tick_ns, wanted)
        if due > 0 and self._advance(due, wanted, time.monotonic_ns() + BATCH):
            self._pacer.is_up_to_date()
            simulator = self._run.simulator
            left = self._pacer.left(simulator.time_ns, simulator.settings.tick_ns,
                                    self._run.ticks_to_wanted())
        return left / SECOND

    def _goes_on(self):
        return not (self._run.paused or self._run.finished) and self._is_ready()

    def _carry_out(self):
        """
        Do what the mailbox holds, each at the tick boundary before it arrived.

        Returns whether anything of it was a command, which the next tick is to show.
        """
        mailbox, pacer = self.mailbox, self._pacer
        arrival, is_commanded = mailbox.arrival(), False
        if arrival is None:
            return False
        limit = time.monotonic_ns() + LONGEST_LAG
        while arrival is not None:
            if self._goes_on():
                simulator, wanted = self._run.simulator, self._run.ticks_to_wanted()
                due = pacer.due_before(arrival, simulator.time_ns, simulator.settings.tick_ns,
                                       wanted)
                if due > 0:
                    self._advance(due, wanted, limit)
            letter = mailbox.next_letter()
            letter.carry_out()
            is_commanded |= not letter.is_awaited
            arrival = mailbox.arrival()
        return is_commanded

    def _show(self):
        """Run the tick that shows what was commanded, if ticks are quick and it is the next."""
        run, pacer = self._run, self._pacer
        if (self._bursts.period is not None and self._goes_on() and run.ticks_to_wanted() == 1
                and pacer.now() >= pacer.deadline(run.simulator.time_ns)):
            run.advance(1, True)
            pacer.is_up_to_date()

    def _advance(self, due, wanted, limit):
        """
        Run so many ticks, until a limit of the steady clock [ns]; return whether all are.

        wanted: how many it is to the first one that somebody waits for.
        """
        run, pacer = self._run, self._pacer
        # It may be that there is no end of this: others have to get on, too.
        self._precedence.give_back()
        while True:
            count = min(due, wanted, self._ticks_in_one_go)
            is_wanted = count == wanted
            begin = time.monotonic_ns()
            if is_wanted and pacer.factor > 0.0:
                simulator = run.simulator
                self.lateness.add(pacer.now() - pacer.deadline(
                    simulator.time_ns + count * simulator.settings.tick_ns))
            run.advance(count, is_wanted)
            due -= count
            # Behind the last tick that is due, none is late.
            pacer.late += is_wanted and due > 0 and pacer.factor > 0.0
            end = time.monotonic_ns()
            if count == self._ticks_in_one_go < wanted:
                self._learn(end - begin)
            if due == 0 or not self._goes_on():
                return True
            if end >= limit:
                return False
            wanted = run.ticks_to_wanted()

    def _learn(self, duration):
        """Choose how many ticks to run in one go by how long that took [ns]."""
        if duration < _GO:
            self._ticks_in_one_go = min(2 * self._ticks_in_one_go, _MOST_IN_ONE_GO)
        elif duration > 4 * _GO:
            self._ticks_in_one_go = max(self._ticks_in_one_go // 2, 1)
