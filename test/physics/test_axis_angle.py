# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The sheet's section 4.2, second bullet: rotations from axis and angle, against scipy."""

from dynsim_ros.physics.rotation import (axis_angle_matrix, axis_angle_quaternion,
                                         quaternion_product)
from newton_euler import rotation_of
import numpy as np
from plain import compiled_and_plain, vectors
import pytest
from scipy.spatial.transform import Rotation

# On both sides of where a series takes over, and on to several turns.
ANGLES = [0.0, 1e-300, 1e-20, 1e-9, 9.999e-5, 1.0001e-4, 1e-3, 0.1, 1.0, 3.1415926, np.pi, 5.0, 40]


@compiled_and_plain(axis_angle_matrix)
@pytest.mark.parametrize('angle', ANGLES)
def test_matrix(formula, angle):
    for axis in vectors(5):
        rotation = angle * np.array(axis) / np.linalg.norm(axis)
        matrix = np.array(formula(tuple(rotation)))
        np.testing.assert_allclose(matrix, Rotation.from_rotvec(rotation).as_matrix(),
                                   rtol=1e-12, atol=1e-15 * (1 + angle))
        np.testing.assert_allclose(matrix @ matrix.T, np.eye(3), atol=1e-15)


@compiled_and_plain(axis_angle_quaternion)
@pytest.mark.parametrize('angle', ANGLES)
def test_quaternion(formula, angle):
    for axis in vectors(5):
        rotation = angle * np.array(axis) / np.linalg.norm(axis)
        q = np.array(formula(tuple(rotation)))
        expected = np.roll(Rotation.from_rotvec(rotation).as_quat(), 1)
        expected *= np.sign(np.dot(q, expected))
        np.testing.assert_allclose(q, expected, rtol=1e-12, atol=1e-15 * (1 + angle))


@compiled_and_plain(axis_angle_matrix)
def test_small_angles_keep_their_digits(formula):
    matrix = np.array(formula((0.0, 0.0, 3e-9)))
    assert matrix[1, 0] == pytest.approx(3e-9, rel=1e-15)


@compiled_and_plain(quaternion_product)
def test_product_is_the_second_rotation_then_the_first(formula):
    turns = Rotation.random(20, np.random.default_rng(8))
    for a, b in zip(turns[:10], turns[10:]):
        p, q = (tuple(np.roll(turn.as_quat(), 1).tolist()) for turn in (a, b))
        np.testing.assert_allclose(rotation_of(formula(p, q)).as_matrix(), (a * b).as_matrix(),
                                   atol=1e-15)
