# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which ticks are due by a clock, and which are given up."""

from fractions import Fraction
import math

from dynsim_ros.ros.pacing import LONGEST_LAG, Pacer, SECOND
import numpy as np
import pytest

TICK = SECOND // 100


class HandClock:
    """A clock that goes on when it is told to [ns]."""

    def __init__(self):
        self.time = 5 * SECOND

    def __call__(self):
        return self.time


@pytest.fixture
def clock():
    return HandClock()


@pytest.mark.parametrize('factor', [1.0, 0.5, 3.0, 1000.0, 1e-300])
def test_deadlines(clock, factor):
    pacer, first = Pacer(factor, clock), 7 * TICK + 3
    exact = [clock.time + math.ceil((first + k * TICK) / Fraction(factor)) for k in (1, 2, 3, 4)]
    found = pacer.deadlines(first, TICK, 4)
    assert found.dtype == np.int64
    for theirs, one, ours in zip(exact, [pacer.deadline(first + k * TICK) for k in (1, 2, 3, 4)],
                                 found.tolist()):
        # Beyond a thousand million seconds one deadline is as good as another.
        assert one == ours and (abs(ours - theirs) <= 1 or min(ours, theirs) > 10 ** 18)


@pytest.mark.parametrize('by_command', [False, True])
def test_what_is_too_late_is_given_up_whoever_asks(clock, by_command):
    pacer = Pacer(1.0, clock)
    clock.time += 70 * TICK
    if by_command:
        due = pacer.due_before(clock.time, 0, TICK, 1)
    else:
        due, _ = pacer.due(0, TICK, 1)
    # the first of 70 ticks is late by 69 of them
    assert pacer.missed == 69 - LONGEST_LAG // TICK
    assert due == 70 - pacer.missed


def test_a_command_has_the_ticks_before_it_done_first(clock):
    pacer = Pacer(2.0, clock)
    arrival = clock.time + 3 * TICK
    clock.time = arrival + TICK
    assert pacer.due_before(arrival, 0, TICK, 1) == 6
    assert pacer.due_before(arrival, 6 * TICK, TICK, 1) == 0
    assert pacer.missed == 0


def test_nobody_waits_for_what_is_not_wanted(clock):
    pacer = Pacer(1.0, clock)
    clock.time += 70 * TICK
    assert pacer.due(0, TICK, 80) == (0, 10 * TICK)
    assert pacer.due_before(clock.time, 0, TICK, 80) == 70
    assert pacer.missed == 0


def test_as_fast_as_possible(clock):
    pacer = Pacer(0.0, clock)
    assert pacer.due(0, TICK, 8) == (8, 0)
    assert pacer.due_before(clock.time, 0, TICK, 8) == 0
