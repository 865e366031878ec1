# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Flight with gravity, linear drag and wind, against matrix exponentials of many digits."""

from dynsim_ros.integrators.closed_form.flight import flight
from dynsim_ros.integrators.closed_form.phi import decay_and_phis, phi_1
from integrators.closed_form.exact import error, linear_motion
import mpmath as mp
import numpy as np
from plain import compiled_and_plain
import pytest

R, V, G, WIND = (1.0, -2.0, 3.0), (4.0, 0.5, 8.0), (0.3, -0.2, -9.81), (3.0, -1.0, 0.1)
MASS = 0.7
# b t / m
FADINGS = [0.0, 1e-300, 1e-18, 1e-9, 1e-3, 0.3, 0.999, 1.001, 4.0, 50.0, 800.0, 1e6]


def exact(t, acceleration, resistance, wind):
    with mp.workdps(60):
        parts = [linear_motion(t, r, v, resistance, 0, g + resistance * w) for r, v, g, w in zip(
            R, V, acceleration or (0, 0, 0), wind or (0, 0, 0))]
    return zip(*parts)


ARGUMENTS = [0.0, 5e-324, 1e-18, 1e-5, 0.5, 0.99999, -0.99999, 1.0, 3.0, 1e3, 1e300, -2.0]


def mean(terms, x):
    """Return phi of that index by the hypergeometric series of its definition, an integral."""
    return mp.hyp1f1(1, terms + 1, -mp.mpf(x)) / mp.factorial(terms)


@compiled_and_plain(phi_1)
def test_phi_1(formula):
    for x in ARGUMENTS:
        assert abs(formula(x) / mean(1, x) - 1) < 1e-15


@compiled_and_plain(decay_and_phis)
def test_decay_and_phis(formula):
    for x in ARGUMENTS:
        decay, first, second = formula(x)
        assert decay == pytest.approx(float(mp.exp(-mp.mpf(x))), rel=4e-16, abs=1e-320)
        assert abs(first / mean(1, x) - 1) < 1e-15
        assert abs(second / mean(2, x) - 1) < 1e-15


@compiled_and_plain(flight)
@pytest.mark.parametrize('acceleration', [None, G])
@pytest.mark.parametrize('wind', [None, WIND])
@pytest.mark.parametrize('t', [1e-6, 2.0, 1e4])
def test_flight_at_every_strength_of_drag(formula, acceleration, wind, t):
    for fading in FADINGS:
        drag = fading * MASS / t
        position, velocity = exact(t, acceleration, mp.mpf(drag) / mp.mpf(MASS), wind)
        found = formula(t, R, V, acceleration, MASS, drag, wind)
        assert error(found[0], position) < 6e-16
        assert error(found[1], velocity) < 4e-16


@compiled_and_plain(flight)
@pytest.mark.parametrize('acceleration', [None, G])
def test_flight_without_air(formula, acceleration):
    position, velocity = exact(7.0, acceleration, 0, None)
    found = formula(7.0, R, V, acceleration, MASS, None, None)
    assert error(found[0], position) < 2e-16
    assert error(found[1], velocity) < 2e-16


def test_two_flights_are_one():
    for drag in (1e-12, 0.1, 30.0):
        middle = flight(1.7, R, V, G, MASS, drag, WIND)
        end = flight(2.9, *middle, G, MASS, drag, WIND)
        whole = flight(1.7 + 2.9, R, V, G, MASS, drag, WIND)
        np.testing.assert_allclose(end, whole, rtol=1e-15, atol=1e-14)


def test_flight_back_in_time_returns():
    there = flight(1.7, R, V, G, MASS, 0.1, WIND)
    np.testing.assert_allclose(flight(-1.7, *there, G, MASS, 0.1, WIND), (R, V), atol=1e-14)
