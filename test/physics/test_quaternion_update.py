# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The sheet's section 4.2, first bullet: the quaternion updated by H, then normalised."""

from dynsim_ros.physics.rotation import (axis_angle_matrix, matrix_quaternion, quaternion_norm,
                                         quaternion_rate, quaternion_rate_world)
from dynsim_ros.physics.state import normalise
from newton_euler import rotation_distance, rotation_of
import numpy as np
from plain import compiled_and_plain, vectors
import pytest
from scipy.spatial.transform import Rotation


def h_matrix(q):
    """Return H as printed on the sheet."""
    w, x, y, z = q
    return np.array([[-x, -y, -z],
                     [w, -z, y],
                     [z, w, -x],
                     [-y, x, w]])


def quaternions(count):
    for rotation in Rotation.random(count, np.random.default_rng(7)):
        yield tuple(np.roll(rotation.as_quat(), 1).tolist())


def updated(q, omega, h):
    """Return the sheet's q[k + 1], with the printed H, normalised."""
    new = np.array(q) + h * (0.5 * h_matrix(q) @ omega)
    return new / np.linalg.norm(new)


@compiled_and_plain(quaternion_rate)
def test_rate_is_half_of_the_printed_h_times_omega(formula):
    for q, omega in zip(quaternions(20), vectors(20)):
        np.testing.assert_allclose(formula(q, omega), 0.5 * h_matrix(q) @ omega, atol=1e-15)


@compiled_and_plain(quaternion_rate_world)
def test_rate_from_world_components_is_the_same_motion(formula):
    for q, omega in zip(quaternions(20), vectors(20)):
        in_body = rotation_of(q).inv().apply(omega)
        np.testing.assert_allclose(formula(q, omega), 0.5 * h_matrix(q) @ in_body, atol=1e-15)


@compiled_and_plain(quaternion_norm)
def test_norm(formula):
    for a, b in zip(vectors(5), vectors(6)):
        q = (*a, b[0])
        assert formula(q) == pytest.approx(np.sqrt(np.sum(np.square(q))), rel=1e-15)


@compiled_and_plain(normalise)
def test_normalise_divides_by_the_norm_and_tells_what_it_removed(formula):
    y = np.zeros(6 * 2 + 7 * 2 + 4)
    y[12:20] = 1.02, 0, 0, 0, 0, 0.6 * 0.99, 0, 0.8 * 0.99
    assert formula(2, 2, y) == pytest.approx(0.02, rel=1e-13)
    np.testing.assert_allclose(y[12:20], (1, 0, 0, 0, 0, 0.6, 0, 0.8), rtol=1e-15)


def test_both_updates_of_the_sheet_agree_to_first_order_with_body_components_in_h():
    """The gap between them must shrink with the square of the step."""
    for q, omega in zip(quaternions(10), vectors(10)):
        in_body = rotation_of(q).inv().apply(omega)
        gaps = []
        for h in (1e-3, 1e-4):
            turned = np.array(axis_angle_matrix(tuple(h * np.array(omega)))) @ (
                rotation_of(q).as_matrix())
            gaps.append(rotation_distance(updated(q, in_body, h), Rotation.from_matrix(turned)))
        assert gaps[0] < (1e-3 * np.linalg.norm(omega)) ** 2
        assert gaps[1] < 0.011 * gaps[0] + 1e-15


def test_world_components_in_the_printed_h_would_not_agree():
    """The sheet expresses omega in world; its H, as printed, needs body components."""
    q, omega, h = next(quaternions(1)), vectors(1)[0], 1e-4
    exact = Rotation.from_rotvec(h * np.array(omega)) * rotation_of(q)
    in_body = rotation_of(q).inv().apply(omega)
    assert rotation_distance(updated(q, in_body, h), exact) < 1e-8
    assert rotation_distance(updated(q, np.array(omega), h), exact) > 1e-5


@pytest.mark.parametrize('steps', [100, 1000])
def test_both_updates_converge_to_the_exact_rotation(steps):
    """Constant omega for 1 s; scipy's Rotation gives where that leads."""
    q, omega = next(quaternions(1)), np.array([1.0, -2.0, 0.5])
    exact = Rotation.from_rotvec(omega) * rotation_of(q)
    by_h, by_axis_angle = q, rotation_of(q).as_matrix()
    turn = np.array(axis_angle_matrix(tuple(omega / steps)))
    for _ in range(steps):
        by_h = updated(by_h, rotation_of(by_h).inv().apply(omega), 1 / steps)
        by_axis_angle = turn @ by_axis_angle
    assert rotation_distance(by_h, exact) < 1.0 / steps
    # about a fixed axis the axis-angle update is exact
    q_axis_angle = matrix_quaternion(tuple(map(tuple, by_axis_angle)))
    assert rotation_distance(q_axis_angle, exact) < 1e-12
