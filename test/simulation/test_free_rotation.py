# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Torque-free rotation against its closed forms: symmetric top and asymmetric body."""

from dynsim_ros.scene import Box, RigidBody, Scene
from dynsim_ros.simulation import Simulator
from newton_euler import rotation_distance, rotation_of
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.special import ellipj, ellipk

START = Rotation.from_rotvec([0.4, -1.1, 0.6])


def run(body, duration=3.0):
    return Simulator(Scene(bodies=(body,)), integrator='rk4', step=2e-4, rate=50).run(duration)


def start(omega):
    """Return the initial conditions for an angular velocity (3,) in body axes."""
    return {'name': 'b', 'orientation': np.roll(START.as_quat(), 1),
            'angular_velocity': START.apply(omega)}


@pytest.mark.parametrize('across, along', [(0.4, 0.6), (0.4, 0.1)], ids=['flat', 'long'])
def test_symmetric_top(across, along):
    """It spins at (1 - C / A) omega_z about its own axis, which precesses at |L| / A about L."""
    omega = np.array([1.5, 0.5, 8.0])
    momentum = START.apply(np.array([across, across, along]) * omega)
    found = run(RigidBody(mass=1, inertia=(across, across, along), **start(omega)))
    own = np.array([0, 0, (1 - along / across) * omega[2]])
    for t, q in zip(found.time, found.orientation('b')):
        expected = Rotation.from_rotvec(momentum / across * t) * START * Rotation.from_rotvec(
            own * t)
        assert rotation_distance(q, expected) < 1e-10
    axis = rotation_of(found.orientation('b')).apply([0, 0, 1])
    cosine = axis @ momentum / np.linalg.norm(momentum)
    np.testing.assert_allclose(cosine, cosine[0], atol=1e-12)


def asymmetric(omega_1, omega_3):
    """Return a box and its angular velocity in body axes over time (Landau-Lifshitz, 37)."""
    edges = np.array([1.0, 0.7, 0.3])
    i1, i2, i3 = moments = (np.square(edges).sum() - np.square(edges)) / 12
    assert i1 < i2 < i3
    twice_energy = i1 * omega_1 ** 2 + i3 * omega_3 ** 2
    squared = (i1 * omega_1) ** 2 + (i3 * omega_3) ** 2
    assert squared > twice_energy * i2
    rate = np.sqrt((i3 - i2) * (squared - twice_energy * i1) / (i1 * i2 * i3))
    m = (i2 - i1) * (twice_energy * i3 - squared) / (
        (i3 - i2) * (squared - twice_energy * i1))

    def omega(t):
        sn, cn, dn, _ = ellipj(rate * t, m)
        middle = np.sqrt((twice_energy * i3 - squared) / (i2 * (i3 - i2)))
        return np.transpose([omega_1 * cn, middle * sn, omega_3 * dn])

    return Box(mass=1, size=edges, **start((omega_1, 0, omega_3))), moments, omega, (rate, m)


def test_asymmetric_box_moves_by_jacobis_elliptic_functions():
    body, moments, omega, _ = asymmetric(2.0, 3.0)
    found = run(body)
    turns = rotation_of(found.orientation('b'))
    in_body = turns.inv().apply(found.angular_velocity('b'))
    np.testing.assert_allclose(in_body, omega(found.time), atol=1e-11)
    # and the orientation is the one that keeps the angular momentum in world where it is
    np.testing.assert_allclose(turns.apply(moments * omega(found.time)),
                               np.tile(START.apply(moments * [2.0, 0, 3.0]), (151, 1)),
                               atol=1e-11)


def test_angular_velocity_of_the_box_comes_back_after_a_period():
    body, _, _, (rate, m) = asymmetric(2.0, 3.0)
    period = 4 * ellipk(m) / rate
    simulator = Simulator(Scene(bodies=(body,)), integrator='rk4', step=2e-4)
    simulator.advance(round(period * 1e9))
    end = simulator.snapshot()
    in_body = rotation_of(end.orientation('b')).inv().apply(end.angular_velocity('b'))
    # the period is rounded to 1 ns
    np.testing.assert_allclose(in_body, (2.0, 0.0, 3.0), atol=1e-8)


def test_cube_spins_on_unchanged():
    found = run(Box(mass=1, size=(0.3, 0.3, 0.3), **start((1.0, 2.0, 3.0))))
    omegas = found.angular_velocity('b')
    np.testing.assert_array_equal(omegas, np.tile(omegas[0], (151, 1)))
    for t, q in zip(found.time, found.orientation('b')):
        assert rotation_distance(q, Rotation.from_rotvec(omegas[0] * t) * START) < 1e-11
