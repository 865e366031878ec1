# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The sequences of an extrapolation: each is in a lane once, and their weights extrapolate."""

from fractions import Fraction

from dynsim_ros.integrators import gragg, stiff, stormer
from dynsim_ros.integrators.gragg import gragg_schedule
from dynsim_ros.integrators.lane_schedule import (ENDED, ERROR, extrapolation_weights, FIRST,
                                                  place_of, SECOND, WEIGHT)
from dynsim_ros.integrators.stiff import stiff_schedule
from dynsim_ros.integrators.stormer import stormer_schedule
import numpy as np
import pytest

# What a sequence of n substeps takes beyond the rate at the start, and powers of h in its error.
RULES = {'gragg': (gragg_schedule, lambda n: n - 1, 2),
         'stormer': (stormer_schedule, lambda n: n, 2),
         'stiff': (stiff_schedule, lambda n: n, 1)}
ALL = [('gragg', range(2, 2 * k + 1, 2), k) for k in range(2, 9)]
ALL += [(rule, range(1, k + 1), k) for rule in ('stormer', 'stiff') for k in range(2, 9)]
ALL += [(rule, each.substeps, each.stages or len(each.substeps))
        for rule, sequences in (('gragg', gragg.SEQUENCES), ('stormer', stormer.SEQUENCES))
        for each in sequences]
ALL += [('stiff', stiff.SUBSTEPS, len(stiff.SUBSTEPS))]


def part(plan, which):
    """Return a part of all rows: (rows, 4)."""
    return np.array([plan.table[place_of.py_func(row, which):][:4] for row in range(plan.rows)])


def sequences(plan):
    """Return {substeps: (weight, error weight, lane, place in the lane, last row)}."""
    found = {}
    weights, errors, firsts = part(plan, WEIGHT), part(plan, ERROR), part(plan, ENDED)
    for row, lane in np.argwhere(weights):
        place = 0 if firsts[row, lane] else 1
        n = plan.table[(FIRST, SECOND)[place] + lane]
        assert n not in found
        found[n] = weights[row, lane], errors[row, lane], lane, place, row
    assert firsts.sum() == sum(place == 0 for _, _, _, place, _ in found.values())
    return found


@pytest.mark.parametrize('rule, substeps, stages', ALL)
def test_every_sequence_is_in_one_lane_and_ends_where_its_last_row_is(rule, substeps, stages):
    schedule, evaluations, _ = RULES[rule]
    plan = schedule(substeps, stages)
    found = sequences(plan)
    assert plan.stages == stages
    assert sorted(found) == list(substeps)
    lanes = np.zeros(4)
    for place in range(2):
        for n, (_, _, lane, where, row) in found.items():
            if where == place:
                lanes[lane] += evaluations(n)
                assert row == lanes[lane] - 1
    assert lanes.max() == plan.rows
    assert (set(np.flatnonzero(plan.ends).tolist())
            == {int(row) for _, _, _, _, row in found.values()})


@pytest.mark.parametrize('rule, substeps, stages', ALL)
def test_no_lane_takes_longer_than_the_longest_or_half_of_them_all(rule, substeps, stages):
    schedule, evaluations, _ = RULES[rule]
    each = [evaluations(n) for n in substeps]
    assert schedule(substeps, stages).rows <= max(max(each), sum(each) / 2)


@pytest.mark.parametrize('rule, substeps, stages', ALL)
def test_the_weights_take_all_powers_of_the_error_away_but_the_last(rule, substeps, stages):
    """What each sequence gives is a polynomial in its (1 / n)^power, wanted is that at 0."""
    schedule, _, power = RULES[rule]
    found = sequences(schedule(substeps, stages))
    n = np.array(sorted(found))
    weights, errors = np.array([found[m][:2] for m in n]).T
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
    assert row == [extrapolation_weights(substeps, power, len(substeps))]


@pytest.mark.parametrize('power', [1, 2])
def test_more_sequences_than_stages_let_the_least_rounding_through(power):
    """Of all weights that extrapolate as far, numpy finds those of the least sum w^2 / n."""
    n, stages = np.array([2.0, 3.0, 4.0, 6.0, 7.0]), 3
    powers = n ** (-float(power) * np.arange(stages)[:, None])
    least = np.linalg.lstsq(powers * np.sqrt(n), np.eye(stages)[0], rcond=None)[0] * np.sqrt(n)
    found = extrapolation_weights([2, 3, 4, 6, 7], power, stages)
    np.testing.assert_allclose([float(found[int(m)]) for m in n], least, rtol=1e-10)


def combined(now, before, ratio):
    """Return the next entry of the tableau as weights."""
    return {n: now.get(n, 0) + (now.get(n, 0) - before.get(n, 0)) / (ratio - 1)
            for n in now | before}
