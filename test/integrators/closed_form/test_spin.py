# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Free spin and spin-down of a body with scalar inertia, against matrix exponentials by mpmath."""

from dynsim_ros.integrators.closed_form.spin import (free_spin, keeps_axis, spin_down,
                                                     turn_and_spin)
from integrators.closed_form.exact import (angle_between, EPS, error, linear_motion, matrix_of,
                                           turn_about)
import mpmath as mp
import numpy as np
from plain import compiled_and_plain
import pytest

Q = (0.5, -0.1, 0.7, -0.5)
OMEGA = (20.0, -10.0, 5.0)
INERTIA = 2e-4
ZERO = (0.0, 0.0, 0.0)
WHIRLS = [ZERO, (-4.0, 2.0, -1.0), (400.0, -200.0, 100.0)]


def exact(t, omega, drag, whirl):
    """Return rotation matrix and angular velocity: the angle is to omega as position to speed."""
    with mp.workdps(50):
        rate = mp.mpf(drag) / mp.mpf(INERTIA)
        parts = [linear_motion(t, 0, w, rate, 0, rate * a)
                 for w, a in zip(omega, whirl)]
        return turn_about([part[0] for part in parts]) * matrix_of(Q), [part[1] for part in parts]


@compiled_and_plain(spin_down)
@pytest.mark.parametrize('whirl', WHIRLS)
@pytest.mark.parametrize('drag', [0.0, 1e-22, 1e-8, 5e-4, 1.0])
def test_spin_down(formula, whirl, drag):
    size = np.linalg.norm(OMEGA) + np.linalg.norm(whirl)
    for t in (0.0, 1e-3, 0.7, 1e4):
        matrix, omega = exact(t, OMEGA, drag, whirl)
        q, found, _ = formula(t, Q, OMEGA, INERTIA, drag, whirl, ZERO)
        assert angle_between(q, matrix) < 5e-16 + EPS * size * t
        assert error(found, omega) < 2e-15


@compiled_and_plain(free_spin)
@pytest.mark.parametrize('omega', [(0.0, 0.0, 0.0), OMEGA, (1e-9, 0.0, 0.0), (6e4, -7e4, 5e4)])
def test_free_spin(formula, omega):
    for t in (0.0, 2.0, 1e4):
        matrix, _ = exact(t, omega, 0.0, ZERO)
        q, found = formula(t, Q, omega)
        assert angle_between(q, matrix) < 5e-16 + EPS * np.linalg.norm(omega) * t
        assert found == omega


def test_angular_velocity_in_air_that_whirls_about_any_axis():
    whirl = (0.0, 3.0, 2.0)
    _, omega = exact(0.3, OMEGA, 5e-4, whirl)
    assert error(turn_and_spin(0.3, OMEGA, INERTIA, 5e-4, whirl, ZERO)[1], omega) < 2e-15


def test_two_spins_are_one():
    more = INERTIA, 5e-4, WHIRLS[1], ZERO
    q, omega, _ = spin_down(0.3, *spin_down(0.2, Q, OMEGA, *more)[:2], *more)
    whole = spin_down(0.2 + 0.3, Q, OMEGA, INERTIA, 5e-4, WHIRLS[1], ZERO)
    np.testing.assert_allclose([*q, *omega], [*whole[0], *whole[1]], atol=2e-15)


@compiled_and_plain(keeps_axis)
def test_which_whirl_keeps_the_axis(formula):
    for whirl in WHIRLS:
        assert formula(OMEGA, whirl)
    assert formula((0.0, 0.0, 0.0), OMEGA)
    assert not formula(OMEGA, (-4.0, 2.0, -1.00001))
    assert not formula(OMEGA, (0.0, 0.0, 1e-9))
