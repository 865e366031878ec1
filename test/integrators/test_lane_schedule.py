# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The sequences of an extrapolation: each is in a lane once, and their weights extrapolate."""

from fractions import Fraction

from dynsim_ros.integrators.gragg import gragg_schedule
from dynsim_ros.integrators.lane_schedule import (ENDS, extrapolation_weights, FIRST, FIRST_ERROR,
                                                  FIRST_WEIGHT, SECOND, SECOND_ERROR,
                                                  SECOND_WEIGHT)
from dynsim_ros.integrators.stiff import stiff_schedule
from dynsim_ros.integrators.stormer import stormer_schedule
import numpy as np
import pytest

# What a sequence of n substeps takes beyond the rate at the start, and powers of h in its error.
RULES = {'gragg': (gragg_schedule, lambda k: 2 * k, lambda n: n - 1, 2),
         'stormer': (stormer_schedule, lambda k: k, lambda n: n, 2),
         'stiff': (stiff_schedule, lambda k: k, lambda n: n, 1)}
ALL = [(rule, stages) for rule in RULES for stages in range(2, 9)]


def sequences(plan):
    """Return {substeps: (weight, error weight, lane, place in the lane)}."""
    found = {}
    for place, (substeps, weight, error) in enumerate((
            (FIRST, FIRST_WEIGHT, FIRST_ERROR), (SECOND, SECOND_WEIGHT, SECOND_ERROR))):
        for lane in range(4):
            if plan.table[weight + lane] != 0.0:
                n = plan.table[substeps + lane]
                assert n not in found
                found[n] = plan.table[weight + lane], plan.table[error + lane], lane, place
    return found


def ends(plan):
    """Return (2, rows, 4): 1 where a first, a second sequence ends."""
    return plan.table[ENDS:].reshape(2, plan.rows, 4)


@pytest.mark.parametrize('rule, stages', ALL)
def test_every_sequence_is_in_one_lane_and_ends_where_its_last_row_is(rule, stages):
    schedule, substeps, evaluations, _ = RULES[rule]
    plan = schedule(stages)
    found = sequences(plan)
    assert plan.stages == stages
    assert sorted(found) == [substeps(k) for k in range(1, stages + 1)]
    lanes = np.zeros(4)
    for place in range(2):
        for n, (_, _, lane, where) in found.items():
            if where == place:
                lanes[lane] += evaluations(n)
                rows = ends(plan)[place, :, lane]
                assert np.flatnonzero(rows).tolist() == [lanes[lane] - 1]
    assert lanes.max() == plan.rows
    assert ends(plan).sum() == stages
    assert plan.first_end == np.flatnonzero(ends(plan)[0].any(axis=1))[0]


@pytest.mark.parametrize('rule, stages', ALL)
def test_no_lane_takes_longer_than_the_longest_sequence_or_half_of_them_all(rule, stages):
    schedule, substeps, evaluations, _ = RULES[rule]
    each = [evaluations(substeps(k)) for k in range(1, stages + 1)]
    assert schedule(stages).rows <= max(max(each), sum(each) / 2)


@pytest.mark.parametrize('rule, stages', ALL)
def test_the_weights_take_all_powers_of_the_error_away_but_the_last(rule, stages):
    """What each sequence gives is a polynomial in its (1 / n)^power, wanted is that at 0."""
    schedule, _, _, power = RULES[rule]
    n = np.array(sorted(sequences(schedule(stages))))
    weights, errors = np.array([sequences(schedule(stages))[m][:2] for m in n]).T
    for j in range(stages):
        terms = weights * n ** (-float(power * j))
        assert terms.sum() == pytest.approx(float(j == 0), abs=1e-15 * np.abs(terms).sum())
        terms = errors * n ** (-float(power * j))
        is_zero = abs(terms.sum()) <= 2e-15 * np.abs(terms).sum()
        assert is_zero == (j < stages - 1)


@pytest.mark.parametrize('power', [1, 2])
def test_the_weights_are_those_of_aitken_and_neville(power):
    """T[j, k + 1] = T[j, k] + (T[j, k] - T[j - 1, k]) / ((n_j / n_{j-k})^power - 1)."""
    substeps = [1, 2, 3, 5, 8]
    row = [{n: Fraction(1)} for n in substeps]
    for k in range(1, len(substeps)):
        ratios = [Fraction(*pair) ** power for pair in zip(substeps[k:], substeps)]
        row = [combined(*entries) for entries in zip(row[1:], row, ratios)]
    assert row == [extrapolation_weights(substeps, power)]


def combined(now, before, ratio):
    """Return the next entry of the tableau as weights."""
    return {n: now.get(n, 0) + (now.get(n, 0) - before.get(n, 0)) / (ratio - 1)
            for n in now | before}
