# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What any free rotation keeps to, and principal axes of any inertia."""

from dynsim_ros.integrators.closed_form.principal_axes import principal_axes
from dynsim_ros.integrators.closed_form.torque_free import torque_free
from dynsim_ros.integrators.closed_form.torque_free_setup import torque_free_setup
from dynsim_ros.scene import load_scene, with_values
from newton_euler import NewtonEuler, rotation_distance, rotation_of
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

# What a body may have: from a needle and a plate to nearly a ball, in any axes.
BODIES = {'box': (1.0, 1.5, 2.3), 'needle': (1e-6, 1.0, 1.0 + 3e-7), 'plate': (1.0, 1.2, 2.1999),
          'ball': (1.0, 1.0 + 1e-9, 1.0 + 3e-9), 'top': (1.0, 1.0, 1.7)}


def inertia_of(name):
    """Return a (3, 3) inertia whose principal axes are not the body's axes."""
    turned = Rotation.from_rotvec([0.3, -1.2, 0.7]).as_matrix()
    matrix = turned @ np.diag(BODIES[name]) @ turned.T
    return (matrix + matrix.T) / 2


def starts(count=10):
    """Return (q, omega): slow and fast, and near axes and separatrices by chance."""
    random = np.random.default_rng(7)
    for i in range(count):
        q = random.normal(size=4)
        yield (tuple((q / np.linalg.norm(q)).tolist()),
               tuple((random.normal(size=3) * 10.0 ** (i % 8 - 3)).tolist()))


def momentum_and_energy(inertia, q, omega):
    matrix = rotation_of(q).as_matrix()
    momentum = matrix @ inertia @ matrix.T @ omega
    return momentum, momentum @ omega / 2


@pytest.mark.parametrize('name', BODIES)
def test_angular_momentum_and_energy_stay(name):
    inertia = inertia_of(name)
    axes = principal_axes(inertia)
    for q, omega in starts():
        motion = torque_free_setup(*axes, q, omega)
        momentum, energy = momentum_and_energy(inertia, q, omega)
        for t in (0.0, 0.1, 3.0, 1e4):
            end, after = torque_free(motion, t)
            now = momentum_and_energy(inertia, end, after)
            assert abs(np.linalg.norm(end) - 1) < 2e-15
            assert np.linalg.norm(now[0] - momentum) < 1e-14 * np.linalg.norm(momentum)
            assert abs(now[1] - energy) < 1e-14 * energy


@pytest.mark.parametrize('name', ['box', 'plate', 'top'])
def test_two_rotations_are_one(name):
    axes = principal_axes(inertia_of(name))
    for q, omega in starts():
        spin = np.linalg.norm(omega)
        t = 3.0 / spin
        middle = torque_free(torque_free_setup(*axes, q, omega), t)
        end, after = torque_free(torque_free_setup(*axes, *middle), 2 * t)
        whole, whole_after = torque_free(torque_free_setup(*axes, q, omega), 3 * t)
        assert rotation_distance(end, rotation_of(whole)) < 2e-13
        np.testing.assert_allclose(after, whole_after, atol=2e-13 * spin)


def test_turning_the_start_turns_the_motion():
    axes = principal_axes(inertia_of('box'))
    turned = Rotation.from_rotvec([1.0, 2.0, -0.5])
    for q, omega in starts():
        t = 30.0 / np.linalg.norm(omega)
        end, after = torque_free(torque_free_setup(*axes, q, omega), t)
        other = tuple(np.roll((turned * rotation_of(q)).as_quat(), 1).tolist())
        motion = torque_free_setup(*axes, other, tuple(turned.apply(omega).tolist()))
        other_end, other_after = torque_free(motion, t)
        assert rotation_distance(other_end, turned * rotation_of(end)) < 2e-13
        np.testing.assert_allclose(other_after, turned.apply(after),
                                   atol=2e-13 * np.linalg.norm(omega))


def test_quaternion_turns_without_a_jump():
    motion = torque_free_setup(*principal_axes(inertia_of('box')), (1.0, 0.0, 0.0, 0.0),
                               (0.01, 3.0, 0.02))
    ends = np.array([torque_free(motion, t)[0] for t in np.linspace(-20, 20, 2001)])
    assert np.linalg.norm(np.diff(ends, axis=0), axis=1).max() < 0.02 * 3 * 0.6


def test_box_of_a_scene_against_the_equations_of_motion_solved_by_scipy():
    scene = with_values(load_scene('spinning_box'), {'box.angular_velocity': (1, 3, -2)})
    solver = NewtonEuler(scene)
    box = scene.bodies[0]
    motion = torque_free_setup(*principal_axes(solver.inertia['box']), box.orientation,
                               box.angular_velocity)
    for t, exact in zip((1.0, 5.0), solver.solve([1.0, 5.0])):
        q, omega = torque_free(motion, t)
        _, _, matrix, expected = exact['box']
        assert rotation_distance(q, Rotation.from_matrix(matrix)) < 1e-11
        np.testing.assert_allclose(omega, expected, atol=1e-11)


@pytest.mark.parametrize('name', BODIES)
def test_principal_axes(name):
    moments, axes = principal_axes(inertia_of(name))
    axes = np.array(axes)
    np.testing.assert_allclose(moments, np.linalg.eigvalsh(inertia_of(name)), rtol=1e-15,
                               atol=1e-15)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(axes) == pytest.approx(1.0, abs=1e-15)
    np.testing.assert_allclose(axes @ inertia_of(name) @ axes.T, np.diag(moments), atol=2e-15)


def test_principal_axes_of_a_diagonal_matrix_are_exact():
    moments, axes = principal_axes(np.diag([3.0, 1.0, 2.0]))
    assert moments == (1.0, 2.0, 3.0)
    assert axes == ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
    assert np.linalg.det(principal_axes(np.diag([3.0, 2.0, 1.0]))[1]) == 1.0
