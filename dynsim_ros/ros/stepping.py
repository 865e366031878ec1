# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Steps of a paused run: so many ticks, or until an instant, and not one more."""

from ..simulation.settings import SECOND

# Ticks in one go where nobody waits for those between, so that it can be ended meanwhile.
_AT_ONCE = 256


class Stepping:
    """
    Lets a paused Run go on by whole ticks; all in the run's thread.

    is_ending: function that tells whether the program was asked to end, which ends steps too.
    """

    def __init__(self, run, is_ending):
        self._run, self._is_ending = run, is_ending

    def by(self, ticks):
        """
        Advance by so many ticks and publish each that somebody wants; return (success, message).

        It is over when this returns, and the run paused as before.
        """
        run = self._run
        if not run.paused:
            return False, 'not paused: call ~/pause with data true first'
        if run.waiting:
            return False, ('waiting for /clock: a step would have no time to be published and '
                           'recorded with; start what publishes it')
        left = ticks
        while left > 0 and run.simulator.failure is None and not self._is_ending():
            wanted = run.ticks_to_wanted()
            count = min(left, wanted, _AT_ONCE)
            left -= count
            run.advance(count, count == wanted or left == 0)
        if run.simulator.failure is not None:
            return False, f'{run.simulator.failure}; then call ~/reset'
        if left > 0:
            return False, f'the node is ending: {left} of {ticks} ticks are left, at {run.now()}'
        return True, run.now()

    def until(self, seconds):
        """Advance likewise to the first tick at or after an instant [s]."""
        simulator = self._run.simulator
        ticks = -((simulator.time_ns - round(seconds * SECOND)) // simulator.settings.tick_ns)
        if ticks <= 0 and self._run.paused:
            return False, (f'step_until: {seconds:.9g} s is not after the present, '
                           f'{self._run.now()}')
        return self.by(ticks)
