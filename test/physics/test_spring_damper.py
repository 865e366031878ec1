# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The sheet's section 1.1, sentence by sentence."""

from dynsim_ros.physics.spring_damper import (damper_force, length_and_direction, length_rate,
                                              spring_force)
import numpy as np
from plain import compiled_and_plain, vectors
import pytest


@compiled_and_plain(length_and_direction)
def test_length_is_the_distance_and_u_points_to_q_from_p(formula):
    for r in vectors(20):
        length, u = formula(r, 0.0)
        assert length == pytest.approx(np.linalg.norm(r), rel=1e-15)
        np.testing.assert_allclose(u, np.array(r) / np.linalg.norm(r), rtol=4e-16)


@compiled_and_plain(spring_force)
def test_spring_force_is_minus_k_times_stretch_along_u(formula):
    for r in vectors(20):
        length, u = np.linalg.norm(r), np.array(r) / np.linalg.norm(r)
        np.testing.assert_allclose(formula(70.0, length, 0.4, tuple(u)),
                                   -70.0 * (length - 0.4) * u, rtol=1e-14)


@compiled_and_plain(spring_force)
def test_stretched_spring_pulls_q_back_and_compressed_spring_pushes_it_away(formula):
    up = (0.0, 0.0, 1.0)
    assert formula(10.0, 1.5, 1.0, up) == (0.0, 0.0, -5.0)
    assert formula(10.0, 0.5, 1.0, up) == (0.0, 0.0, 5.0)
    assert formula(10.0, 1.0, 1.0, up) == (0.0, 0.0, 0.0)


@compiled_and_plain(length_rate)
def test_length_rate_is_the_derivative_of_the_length(formula):
    r, v = map(np.array, vectors(2))
    h = 1e-5
    central = (np.linalg.norm(r + h * v) - np.linalg.norm(r - h * v)) / (2 * h)
    assert formula(tuple(v), tuple(r / np.linalg.norm(r))) == pytest.approx(central, abs=1e-9)


@compiled_and_plain(damper_force)
def test_damper_force_is_minus_b_times_length_rate_along_u(formula):
    for u, (rate, _, _) in zip(vectors(10), vectors(10)):
        np.testing.assert_allclose(formula(3.0, rate, u), -3.0 * rate * np.array(u), rtol=1e-15)


@compiled_and_plain(damper_force)
def test_damper_never_gives_energy(formula):
    for r, v in zip(vectors(20), vectors(20)[::-1]):
        u = np.array(r) / np.linalg.norm(r)
        assert np.dot(formula(3.0, np.dot(v, u), tuple(u)), v) <= 0.0


@compiled_and_plain(length_and_direction)
def test_exchange_of_from_and_to_turns_the_forces_round_to_the_bit(formula):
    for r, v in zip(vectors(20), vectors(21)):
        forces = []
        for sign in (1.0, -1.0):
            length, u = formula(tuple(sign * a for a in r), 1e-17)
            rate = length_rate(tuple(sign * a for a in v), u)
            forces.append((spring_force(70.0, length, 0.4, u), damper_force(3.0, rate, u)))
        np.testing.assert_array_equal(forces[0], -np.array(forces[1]))
