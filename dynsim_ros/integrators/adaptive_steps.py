# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A motion advanced in steps that the method chooses, whoever looks at it and when."""

import numpy as np

from .adaptive import (advance, BASE, BUDGET_SPENT, CLOCK_SIZE, COUNTS_SIZE, END, FLOOR, Grid,
                       MARGIN, NEXT, REACHED, REJECTED, STEP, STEP_TOO_SHORT, STEPS, TO_BEGIN)
from .entry import entry
from .memory import DENSE_SIZE, new_memory, STAGES
from .stiffness import EXPLICIT_REACH, spring_rates
from ..physics.structure import with_structure

# Farther ahead than any run goes [ns].
FAR = 2 ** 62
# The most attempts at a step in one go, unless told otherwise: work is bounded, whatever the
# scene.
BUDGET = 200_000
_SECOND = 1_000_000_000


class IntegrationError(ArithmeticError):
    """A method cannot go on with its tolerance."""


class Walk:
    """
    What all adaptive ways to advance a state have in common.

    current: the AdaptiveSteps at work; go(limit, grid): let them, or others, take steps; budget:
    the most attempts at a step in one go.
    """

    removed = 0.0
    budget = BUDGET

    @property
    def shortfall(self):
        """Return, in words, by how much rounding exceeds the tolerance; None if it does not."""
        steps = self.current
        margin = MARGIN * steps.method.share
        if steps.clock[FLOOR] <= margin * steps.tolerance:
            return None
        return (f'the tolerance {steps.tolerance:g} is below what rounding leaves of a motion as '
                f'fast as this one: it is computed to {steps.clock[FLOOR] / margin:.1g}')

    def state_at(self, time_ns, limit_ns=None):
        """
        Return the state at an instant that is not before the last one asked for.

        limit_ns: the next instant that is known to begin something new; the last step ends there.
        """
        if time_ns == self.current.origin:
            return self.current.states[1].copy()
        states = np.empty((1, self.current.states.shape[1]))
        states[0] = self.current.states[1]
        self.fill(time_ns, 1, states, limit_ns)
        return states[0]

    def fill(self, first_ns, period_ns, states, limit_ns=None):
        """Write the states at instants that are evenly spaced to states: (n, size)."""
        origin = self.current.origin
        done = np.zeros(1, dtype=np.int64)
        self.go(FAR if limit_ns is None else limit_ns - origin,
                Grid(first_ns - origin, period_ns, states, done))

    def end_at(self, time_ns):
        """Return the state at an instant at which a step ends."""
        steps = self.current
        self.go(time_ns - steps.origin, steps.nowhere)
        return self.current.end.copy()

    def cut(self, time_ns):
        """Return the state at an instant; a step that has gone past it is taken back to it."""
        usual = self.current.take_back(time_ns)
        state = self.end_at(time_ns)
        clock = self.current.clock
        clock[NEXT] = max(usual, clock.item(NEXT))
        return state


class AdaptiveSteps(Walk):
    """
    Advances a state with an adaptive method.

    method: Adaptive; tolerance: see Settings; watch: see adaptive.advance; else as for FixedSteps.
    The steps depend on where the motion was begun and on `limit_ns`, never on the instants at
    which states are asked for.
    """

    def __init__(self, method, tolerance, model, drive, size, springs, watch=0.0):
        self.method, self.tolerance, self.watch, self.calm = method, tolerance, watch, 0.0
        # In one piece, which is faster to be cleared.
        self._kept = np.zeros(CLOCK_SIZE + COUNTS_SIZE)
        self.clock, self.counts = self._kept[:CLOCK_SIZE], self._kept[CLOCK_SIZE:].view(np.int64)
        kept = DENSE_SIZE + (0 if method.tableaux.radau is None else STAGES)
        self.states, self._dense = np.zeros((4, size)), np.zeros(kept * size)
        self.end = self.states[1]
        self.origin = 0
        # What solves for all springs at once gains little by the structure.
        is_explicit = method.tableaux.stiff is None and method.tableaux.radau is None
        # The first and the last arguments of advance, which stay as they are.
        self._arguments = (
            (with_structure(model, method.keeps_reaches) if is_explicit else model, drive,
             method.tableaux, method.power, method.share * tolerance,
             spring_rates(model)[0] / EXPLICIT_REACH),
            (self.clock, self.counts, self.states, new_memory(size, springs), self._dense))
        self.nowhere = Grid(FAR, 1, np.empty((1, size)), np.zeros(1, dtype=np.int64))
        self._advance = None

    @property
    def current(self):
        """Return the steps at work: these."""
        return self

    def begin(self, time_ns, state):
        """Begin at an instant [ns], in a state: (size,)."""
        self.origin, clock = time_ns, self.clock
        clock[BASE] = clock[END] = 0.0
        clock[STEP] = TO_BEGIN
        self.end[:] = state

    def follow(self, other, step):
        """Go on where other steps have come to, with a first step of a given length [s]."""
        self.origin = other.origin
        self.clock[BASE], self.clock[END] = other.clock[BASE], other.clock[END]
        self.clock[STEP], self.clock[NEXT] = TO_BEGIN, step
        self.states[1] = other.states[1]

    def reset(self):
        """Forget all: the next beginning is the first one."""
        self._kept.fill(0.0)

    def prepare(self):
        """Compile, or load from the cache, what the steps need, or do nothing."""
        self.run(-1, self.nowhere)

    @property
    def attempts(self):
        """Return how many steps were attempted."""
        return self.counts.item(STEPS) + self.counts.item(REJECTED)

    def run(self, limit, grid, budget=BUDGET):
        """Take steps until the grid is filled or the limit reached; return what ended them."""
        first, last = self._arguments
        if self._advance is None:
            self._advance = entry(advance, *first, limit, budget, self.watch, self.calm, *last,
                                  grid)
        return self._advance(*first, limit, budget, self.watch, self.calm, *last, grid)

    def go(self, limit, grid):
        """Take steps as run does; raise IntegrationError if the method cannot go on."""
        status = self.run(limit, grid, self.budget)
        if status != REACHED:
            self.check(status, self.budget)

    def take_back(self, time_ns):
        """Undo the last step if it went past an instant; return the usual length of a step."""
        clock = self.clock
        end, step = clock.item(END), clock.item(STEP)
        behind = time_ns - self.origin - int(clock.item(BASE)) * _SECOND
        if behind * 1e-9 < end and step > 0.0:
            clock[END] = end - step
            self.states[1], self.states[3] = self.states[0], self.states[2]
            clock[STEP] = 0.0
        return clock.item(NEXT)

    def check(self, status, budget):
        """Raise IntegrationError unless a run ended well."""
        if status == BUDGET_SPENT:
            raise IntegrationError(
                f'{budget} steps in one go did not suffice; the last ones were '
                f'{self.clock[NEXT]:.3g} s long: use a larger tolerance than {self.tolerance:g}, '
                'a softer spring, or more mass')
        if status == STEP_TOO_SHORT:
            raise IntegrationError(
                f'even a step of {self.clock[NEXT]:.1g} s does not keep the tolerance '
                f'{self.tolerance:g}: use a larger one, or a method of fixed step')
