# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Rotation in air that whirls about another axis, against the equation of motion by mpmath."""

from dynsim_ros.integrators.closed_form.whirl import (constant_of_whirl, reaches, TERMS,
                                                      terms_needed, whirl_series, whirled)
from integrators.closed_form.exact import angle_between, matrix_of, turn_about
import mpmath as mp
from newton_euler import rotation_of
import numpy as np
from plain import compiled_and_plain
import pytest

Q = (0.5, -0.1, 0.7, -0.5)
# omega, whirl, c: slow and fast, up to the largest turn, whirl faster than spin, no whirl
CASES = [((20.0, 0.0, 0.0), (0.0, 0.0, 2.0), 2.5), ((1.0, -2.0, 3.0), (0.3, 0.5, -0.2), 1.0),
         ((0.1, 0.0, 0.2), (30.0, -7.0, 10.0), 3.3), ((12.0, 0.0, 0.0), (0.0, 0.0, 0.0), 1.25)]


def series_of(omega, whirl, decay):
    series = np.empty((TERMS, 4))
    whirl_series(omega, whirl, decay, series)
    return series


def motion(omega, whirl, decay, q=Q):
    series = series_of(omega, whirl, decay)
    return series, np.array(constant_of_whirl(series, q)), whirl, decay


@compiled_and_plain(whirled)
@pytest.mark.parametrize('case', CASES)
def test_against_the_equation_of_motion(formula, case):
    omega, whirl, decay = case
    assert reaches(*case)
    slip = [w - a for w, a in zip(omega, whirl)]

    def rates(t, q):
        w, x, y, z = q
        a, b, c = (v + d * mp.exp(-decay * t) for v, d in zip(whirl, slip))
        return [(-x * a - y * b - z * c) / 2, (w * a + z * b - y * c) / 2,
                (-z * a + w * b + x * c) / 2, (y * a - x * b + w * c) / 2]

    with mp.workdps(20):
        exact = mp.odefun(rates, 0, [mp.mpf(component) for component in Q])
        for t in (0.0, 0.1, 0.6, 1.3):
            found = formula(t, *motion(*case))
            assert angle_between(found, matrix_of(exact(t))) < 2e-14
            assert abs(np.linalg.norm(found) - 1) < 1e-15


@pytest.mark.parametrize('case', CASES)
def test_after_a_long_time_it_turns_with_the_air(case):
    t, more = 64.0, 8192.0
    q = whirled(t, *motion(*case))
    with mp.workdps(30):
        expected = turn_about([mp.mpf(more) * w for w in case[1]]) * matrix_of(q)
        assert angle_between(whirled(t + more, *motion(*case)), expected) < 2e-15


@pytest.mark.parametrize('case', CASES)
def test_terms_that_are_left_out_are_small(case):
    coefficients = np.linalg.norm(series_of(*case), axis=1)
    for x in (0.0, 0.9999, 1.0, 2.9999, 3.0, 5.9999, 6.0, 20.0):
        powers = np.exp(-x) ** np.arange(len(coefficients))
        assert (coefficients * powers)[terms_needed(x):].sum() < 1e-17
        assert terms_needed(x) % 2 == 0


def test_it_does_not_reach_where_the_spin_lasts():
    assert not reaches((20.0, 0.0, 0.0), (0.0, 0.0, 2.0), 2.0)
    assert not reaches((20.0, 0.0, 0.0), (0.0, 0.0, 2.0), 0.0)


def test_two_rotations_are_one():
    omega, whirl, decay = CASES[0]
    middle = whirled(0.4, *motion(*CASES[0]))
    slower = tuple(a + (w - a) * np.exp(-decay * 0.4) for w, a in zip(omega, whirl))
    end = whirled(0.3, *motion(slower, whirl, decay, middle))
    whole = whirled(0.4 + 0.3, *motion(*CASES[0]))
    assert (rotation_of(end).inv() * rotation_of(whole)).magnitude() < 1e-14
