# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The choice between the explicit and the stiff method, from what the run shows.

The explicit method goes first. Once its steps have stayed for a while where only stability can
hold them back, and velocities hardly change in one, the stiff one tries a step so much longer that
it is worth its cost; if it succeeds it goes on, and hands back once its steps are no longer worth
theirs. After a trial that did not succeed the next one waits longer. All that decides is in the
steps themselves, so that a repeated run decides alike.
"""

import math

from .adaptive import AT_REST, BASE, END, NEXT, postpone, REACHED, STEPS, SWITCH, WAIT
from .adaptive_steps import AdaptiveSteps, FAR, Walk
from .closed_scene import comes_to_rest
from .stiffness import held_back_step

# The first step that a stiff method tries, over what it has to be to be worth it.
_AMBITION = 1.6
# A run is calm when no velocity is above this part of the tolerance [1/s]; it is then at rest
# where the air stops what still moves within the inverse of that, and springs pull nothing farther
# than a part of the tolerance.
_CALM, _NEAR = 1e-2, 0.1
# Stiff steps in a row after which a trial was a success.
_SUCCESS = 20


class AutoSteps(Walk):
    """
    Advances a state with an explicit method, and with a stiff one where that is faster.

    explicit: Adaptive; stiff: returns an Adaptive, called when it is first needed; cost: of a step
    of the stiff one, in steps of the other; else as for AdaptiveSteps.
    """

    def __init__(self, explicit, stiff, cost, tolerance, model, drive, size, springs):
        self._cost = cost
        held_back = held_back_step(model, explicit.reach)
        self.explicit = AdaptiveSteps(explicit, tolerance, model, drive, size, springs,
                                      held_back if held_back < math.inf else 0.0)
        self._new_stiff = lambda: AdaptiveSteps(stiff(), tolerance, model, drive, size, springs)
        self.stiff = None
        self.current = self.explicit
        self._entered = 0
        self._model, self._drive, self._asleep_at = model, drive, None

    @property
    def counts(self):
        """Return what was counted, as in adaptive."""
        return self.explicit.counts + (0 if self.stiff is None else self.stiff.counts)

    def begin(self, time_ns, state):
        """Begin at an instant [ns], in a state: (size,)."""
        self.current.begin(time_ns, state)
        self._asleep_at, self.explicit.calm = None, _CALM * self.explicit.tolerance

    def reset(self):
        """Forget all: the next beginning is the first one."""
        self.explicit.reset()
        if self.stiff is not None:
            self.stiff.reset()
        self.current = self.explicit
        self._entered = 0

    def prepare(self):
        """Compile, or load from the cache, what the steps need, or do nothing."""
        self.explicit.prepare()

    def prepare_ahead(self, state):
        """Compile, or load from the cache, what the stiff method needs; change nothing."""
        if self.explicit.watch > 0.0:
            stiff = self._new_stiff()
            stiff.begin(0, state)
            stiff.prepare()

    def go(self, limit, grid):
        """
        Take steps as AdaptiveSteps.run does, with whichever method is the better one.

        Where the run has come to rest, no more are taken: the state is held.
        """
        if not self._is_asleep():
            self.current.check(self._run(limit, grid), self.budget)
        if self._is_asleep() and grid.first < FAR:
            grid.states[grid.done[0]:] = self.current.states[1]
            grid.done[0] = len(grid.states)

    def _run(self, limit, grid):
        """Take steps; return what ended them."""
        left = self.budget
        while True:
            at_work, before = self.current, self.current.attempts
            status = at_work.run(limit, grid, left)
            left -= (at_work.attempts - before) * (self._cost if at_work is self.stiff else 1)
            left = int(left)
            if status == AT_REST:
                self._fall_asleep()
                if self._is_asleep():
                    return REACHED
            elif status != SWITCH:
                return status
            elif at_work is self.stiff:
                self._hand_back()
            else:
                self._try_stiff(limit, grid)

    def _is_asleep(self):
        # A step that went past a command has been taken back: that was before.
        clock = self.current.clock
        return self._asleep_at is not None and clock[BASE] + clock[END] >= self._asleep_at

    def _fall_asleep(self):
        """Hold the state from here on, if it is one of rest."""
        steps = self.explicit
        if comes_to_rest(self._model, self._drive, steps.states[1], 1.0 / _CALM,
                         _NEAR * steps.tolerance):
            self._asleep_at = steps.clock[BASE] + steps.clock[END]
        else:
            # What is left may be near enough once it is that much slower.
            steps.calm *= 0.1

    def _hand_back(self):
        if self.stiff.counts[STEPS] - self._entered >= _SUCCESS:
            self.explicit.clock[WAIT] = 0.0
        self._postpone()
        self.explicit.follow(self.stiff, self.explicit.clock[NEXT])
        self.current = self.explicit

    def _postpone(self):
        postpone(self.explicit.clock, self.explicit.counts.item(STEPS))

    def _try_stiff(self, limit, grid):
        """Go over to the stiff method if it can take a step that is long enough."""
        if self.stiff is None:
            self.stiff = self._new_stiff()
        usual = self.explicit.clock[NEXT]
        self.stiff.follow(self.explicit, _AMBITION * self._cost * usual)
        self.stiff.watch = -self._cost * usual
        self._entered = self.stiff.counts[STEPS]
        self.stiff.run(limit, grid, budget=1)
        if self.stiff.counts[STEPS] > self._entered:
            self.current = self.stiff
        else:
            self._postpone()
