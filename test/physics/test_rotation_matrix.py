# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Matrix and quaternion of a rotation, both ways, against scipy."""

from dynsim_ros.physics.rotation import matrix_quaternion, rotate, rotation_matrix
from newton_euler import rotation_of
import numpy as np
from plain import compiled_and_plain, vectors
import pytest
from scipy.spatial.transform import Rotation

# Half turns about the axes and near them: the trace or one diagonal element is largest.
BRANCHES = {'w': [0.1, 0.2, 0.3], 'x': [3.1, 0.2, 0.1], 'y': [0.2, 3.1, 0.1],
            'z': [0.1, 0.2, 3.1]}


def rows(matrix):
    return tuple(tuple(row) for row in matrix.tolist())


def some_rotations():
    half_turns = [Rotation.from_rotvec(np.pi * np.eye(3)[i]) for i in range(3)]
    return [*Rotation.random(50, np.random.default_rng(9)), *half_turns, Rotation.identity()]


@compiled_and_plain(rotation_matrix)
def test_matrix_of_a_quaternion(formula):
    for rotation in some_rotations():
        q = tuple(np.roll(rotation.as_quat(), 1).tolist())
        np.testing.assert_allclose(formula(q), rotation.as_matrix(), atol=1e-15)


@compiled_and_plain(rotate)
def test_rotated_vector(formula):
    for rotation, a in zip(some_rotations(), vectors(50)):
        q = tuple(np.roll(rotation.as_quat(), 1).tolist())
        np.testing.assert_allclose(formula(q, a), rotation.apply(a), atol=2e-15)


@compiled_and_plain(matrix_quaternion)
@pytest.mark.parametrize('largest', list(BRANCHES))
@pytest.mark.parametrize('sign', [1, -1])
def test_quaternion_of_a_matrix_in_each_branch(formula, largest, sign):
    rotation = Rotation.from_rotvec(sign * np.array(BRANCHES[largest]))
    q = np.array(formula(rows(rotation.as_matrix())))
    assert 'wxyz'[np.argmax(np.abs(q))] == largest
    expected = np.roll(rotation.as_quat(), 1)
    np.testing.assert_allclose(q, expected * np.sign(expected[0]), atol=2e-15)


@compiled_and_plain(matrix_quaternion)
def test_there_and_back(formula):
    for rotation in some_rotations():
        q = formula(rows(rotation.as_matrix()))
        assert q[0] >= 0.0
        assert np.linalg.norm(q) == pytest.approx(1.0, abs=1e-15)
        np.testing.assert_allclose(rotation_of(q).as_matrix(), rotation.as_matrix(), atol=2e-15)
