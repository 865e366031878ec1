# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The sheet's section 3: Newton, Euler in full and for a scalar inertia, moment of a force."""

from dynsim_ros.physics.equations_of_motion import (angular_acceleration, linear_acceleration,
                                                    moment_of_force, scalar_angular_acceleration)
from dynsim_ros.physics.model import build_model
from dynsim_ros.scene import Box, Scene
import numpy as np
from plain import compiled_and_plain, vectors
from scipy.spatial.transform import Rotation

INERTIA = np.array([[2.0, 0.3, -0.1], [0.3, 1.5, 0.2], [-0.1, 0.2, 1.0]])


def rows(matrix):
    return tuple(tuple(row) for row in np.asarray(matrix, dtype=float).tolist())


def solved(formula, inertia, rotation, moment, omega):
    return formula(moment, rows(inertia), rows(np.linalg.inv(inertia)), rows(rotation), omega)


@compiled_and_plain(linear_acceleration)
def test_newton(formula):
    for force in vectors(10):
        np.testing.assert_allclose(2.5 * np.array(formula(force, 0.4)), force, rtol=1e-15)


@compiled_and_plain(angular_acceleration)
def test_euler_in_full(formula):
    turns = Rotation.random(10, np.random.default_rng(6)).as_matrix()
    for turn, moment, omega in zip(turns, vectors(10), vectors(11)):
        in_world = turn @ INERTIA @ turn.T
        alpha = np.array(solved(formula, INERTIA, turn, moment, omega))
        np.testing.assert_allclose(in_world @ alpha + np.cross(omega, in_world @ omega), moment,
                                   atol=1e-14)


@compiled_and_plain(angular_acceleration)
def test_euler_is_the_derivative_of_angular_momentum(formula):
    turn = Rotation.from_rotvec([0.3, -1.0, 0.7])
    moment, omega = map(np.array, vectors(2))
    alpha = np.array(solved(formula, INERTIA, turn.as_matrix(), tuple(moment), tuple(omega)))

    def momentum(t):
        matrix = (Rotation.from_rotvec(omega * t) * turn).as_matrix()
        return matrix @ INERTIA @ matrix.T @ (omega + alpha * t)

    np.testing.assert_allclose((momentum(1e-5) - momentum(-1e-5)) / 2e-5, moment, atol=1e-9)


@compiled_and_plain(scalar_angular_acceleration)
def test_scalar_inertia(formula):
    for moment in vectors(10):
        np.testing.assert_allclose(0.4 * np.array(formula(moment, 2.5)), moment, rtol=1e-15)


@compiled_and_plain(angular_acceleration)
def test_full_equation_collapses_to_the_scalar_one_where_inertia_is_a_scalar(formula):
    turn = Rotation.from_rotvec([0.3, -1.0, 0.7]).as_matrix()
    moment, omega = vectors(2)
    np.testing.assert_allclose(solved(formula, 0.4 * np.eye(3), turn, moment, omega),
                               scalar_angular_acceleration(moment, 2.5), rtol=1e-14)


@compiled_and_plain(angular_acceleration)
def test_box_that_is_no_cube_accelerates_without_a_moment(formula):
    inertia = build_model(Scene(bodies=(Box(name='b', mass=1, size=(1, 2, 3)),))).inertia[0]
    alpha = solved(formula, inertia, np.eye(3), (0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    # Euler: alpha_x = (I_y - I_z) / I_x and so on, with 12 I = 13, 10, 5
    np.testing.assert_allclose(alpha, (5 / 13, -8 / 10, 3 / 5), rtol=1e-14)


@compiled_and_plain(moment_of_force)
def test_moment_of_a_force_at_q(formula):
    for arm, force in zip(vectors(10), vectors(11)):
        np.testing.assert_allclose(formula(arm, force), np.cross(arm, force), rtol=1e-13)
    np.testing.assert_array_equal(formula((0.0, 0.0, 2.0), (0.0, 0.0, 5.0)), 0.0)
