# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Flight and spin in air against their closed forms."""

from dynsim_ros.scene import load_scene, with_values
from dynsim_ros.simulation import Simulator
from newton_euler import rotation_distance, rotation_of
import numpy as np
from scipy.spatial.transform import Rotation

WIND, DOWN = np.array([3.0, 1.0, -0.5]), np.array([0.6, 0.0, -0.8])


def ball(**values):
    return with_values(load_scene('falling_in_wind'), {
        name.replace('__', '.'): value for name, value in values.items()})


def run(scene):
    return Simulator(scene, integrator='rk4', step=2e-4, rate=50).run(2.0)


def test_ballistic_flight_in_wind():
    """Show m v' = m g down - b (v - wind) for any direction of down."""
    scene = ball(down=DOWN, air__velocity=WIND, air__linear_drag=0.2)
    body, rate = scene.bodies[0], 0.2 / 0.2
    r, v = np.array(body.position), np.array(body.velocity)
    final = WIND + 9.81 / rate * DOWN
    found = run(scene)
    t = found.time[:, None]
    decay = np.exp(-rate * t)
    np.testing.assert_allclose(found.velocity('ball'), final + (v - final) * decay, atol=1e-12)
    np.testing.assert_allclose(found.position('ball'),
                               r + final * t + (v - final) * (1 - decay) / rate, atol=1e-12)


def test_without_drag_it_is_a_parabola():
    scene = ball(air__linear_drag=0)
    body, found = scene.bodies[0], run(scene)
    t = found.time[:, None]
    expected = np.array(body.position) + t * body.velocity - 9.81 / 2 * t ** 2 * [[0, 0, 1]]
    np.testing.assert_allclose(found.position('ball'), expected, atol=1e-12)


def test_spin_decays_towards_the_whirl_of_the_air():
    """I omega' = -b (omega - whirl), I = 2/5 m r^2, also for omega across the whirl."""
    whirl, omega = np.array([0.0, 1.0, 2.0]), np.array([20.0, -3.0, 0.0])
    rate = 5e-4 / (2 / 5 * 0.2 * 0.05 ** 2)
    found = run(ball(air__angular_velocity=whirl, ball__angular_velocity=omega))
    expected = whirl + (omega - whirl) * np.exp(-rate * found.time[:, None])
    np.testing.assert_allclose(found.angular_velocity('ball'), expected, atol=2e-11)


def test_angle_of_a_spin_down_about_one_axis():
    axis, start = np.array([2.0, 1.0, -2.0]) / 3, Rotation.from_rotvec([0.3, 0.1, -0.7])
    rate = 5e-4 / (2 / 5 * 0.2 * 0.05 ** 2)
    found = run(ball(air__angular_velocity=2 * axis, ball__angular_velocity=20 * axis,
                     ball__orientation=start.as_quat()))
    angles = 2 * found.time + 18 * (1 - np.exp(-rate * found.time)) / rate
    for q, angle in zip(found.orientation('ball'), angles):
        assert rotation_distance(q, Rotation.from_rotvec(angle * axis) * start) < 2e-12
    assert rotation_distance(found.orientation('ball')[0], rotation_of(np.roll(
        start.as_quat(), 1))) < 1e-15
