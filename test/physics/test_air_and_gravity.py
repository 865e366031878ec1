# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The sheet's sections 1.2 and 1.3."""

from dynsim_ros.physics.air_resistance import air_force, air_torque
from dynsim_ros.physics.gravity import gravity_force
from dynsim_ros.scene import Particle, Scene
import numpy as np
from plain import compiled_and_plain, vectors

ZERO = (0.0, 0.0, 0.0)


@compiled_and_plain(air_force)
def test_air_force_opposes_the_velocity_relative_to_the_air(formula):
    for v, wind in zip(vectors(10), vectors(11)):
        np.testing.assert_allclose(formula(0.3, v, wind), -0.3 * (np.array(v) - wind), rtol=1e-15)


@compiled_and_plain(air_force)
def test_a_body_that_moves_with_the_wind_feels_none(formula):
    assert formula(0.3, (1.0, 2.0, 3.0), (1.0, 2.0, 3.0)) == ZERO


@compiled_and_plain(air_force)
def test_wind_drags_a_body_at_rest_along(formula):
    np.testing.assert_array_equal(formula(0.5, ZERO, (2.0, 0.0, -4.0)), (1.0, 0.0, -2.0))


@compiled_and_plain(air_torque)
def test_air_torque_opposes_the_angular_velocity_relative_to_the_air(formula):
    for omega, whirl in zip(vectors(10), vectors(11)):
        np.testing.assert_allclose(formula(0.02, omega, whirl),
                                   -0.02 * (np.array(omega) - whirl), rtol=1e-15)


@compiled_and_plain(air_torque)
def test_whirl_turns_a_body_at_rest(formula):
    np.testing.assert_array_equal(formula(0.5, ZERO, (0.0, 0.0, 4.0)), (0.0, 0.0, 2.0))


@compiled_and_plain(gravity_force)
def test_gravity_is_m_g_along_down(formula):
    for down in vectors(10):
        down = np.array(down) / np.linalg.norm(down)
        force = formula(2.5, 9.81, tuple(down))
        np.testing.assert_allclose(force, 2.5 * 9.81 * down, rtol=1e-15)


def test_down_of_a_scene_is_made_a_unit_vector_and_points_to_minus_z_by_default():
    ball = Particle(name='b', mass=1)
    assert Scene(bodies=(ball,), gravity=1, down=(0, 3, 4)).down == (0.0, 0.6, 0.8)
    assert Scene(bodies=(ball,)).down == (0.0, 0.0, -1.0)
