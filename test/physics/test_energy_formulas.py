# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Energies against their definitions; their slopes are the forces."""

from dynsim_ros.physics.energy import (gravitational_energy, power, rotational_energy,
                                       scalar_rotational_energy, spring_energy,
                                       translational_energy)
from dynsim_ros.physics.spring_damper import spring_force
import numpy as np
from plain import compiled_and_plain, vectors
import pytest
from scipy.integrate import simpson
from scipy.spatial.transform import Rotation

UP = (0.0, 0.0, 1.0)


@compiled_and_plain(translational_energy)
def test_translation(formula):
    assert formula(3.0, (1.0, 2.0, 2.0)) == 13.5


@compiled_and_plain(scalar_rotational_energy)
def test_rotation_with_a_scalar_inertia(formula):
    assert formula(0.5, (1.0, 2.0, 2.0)) == 2.25


@compiled_and_plain(rotational_energy)
def test_rotation_in_full(formula):
    inertia = np.array([[2.0, 0.3, -0.1], [0.3, 1.5, 0.2], [-0.1, 0.2, 1.0]])
    turn = Rotation.from_rotvec([0.3, -1.0, 0.7]).as_matrix()
    for omega in map(np.array, vectors(5)):
        found = formula(tuple(map(tuple, inertia)), tuple(map(tuple, turn)), tuple(omega))
        assert found == pytest.approx(0.5 * omega @ turn @ inertia @ turn.T @ omega, rel=1e-14)


@compiled_and_plain(gravitational_energy)
def test_gravity_is_m_g_times_height(formula):
    assert formula((0.0, 0.0, -20.0), (5.0, 6.0, 0.25)) == 5.0


@compiled_and_plain(spring_energy)
def test_spring_energy_is_the_work_against_the_spring_force(formula):
    lengths = np.linspace(0.5, 1.2, 1001)
    against = [-spring_force(70.0, length, 0.5, UP)[2] for length in lengths]
    assert formula(70.0, 1.2, 0.5) == pytest.approx(simpson(against, x=lengths), rel=1e-12)


@compiled_and_plain(power)
def test_power(formula):
    assert formula((1.0, 2.0, 3.0), (4.0, -5.0, 6.0)) == 12.0
