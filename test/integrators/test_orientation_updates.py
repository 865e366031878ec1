# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Both orientation updates of the sheet against each other and against what each does exactly."""

from dynsim_ros.scene import load_scene, with_values
from dynsim_ros.simulation import Simulator
from newton_euler import rotation_distance, rotation_of
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

OMEGA = np.array([1.0, -2.0, 2.0])
DURATION = 1.0


def spun(method, step, scene=None):
    """Return (orientation at the end, Simulator) of a sphere that turns at constant OMEGA."""
    scene = scene or with_values(load_scene('falling_in_wind'), {
        'air.rotational_drag': 0, 'ball.angular_velocity': OMEGA})
    simulator = Simulator(scene, step=step, integrator=method)
    simulator.advance(round(DURATION * 1e9))
    return simulator.snapshot().orientation(scene.bodies[0].name), simulator


@pytest.mark.parametrize('step', [0.1, 0.01])
def test_a_step_of_the_h_update_turns_by_twice_the_arctangent_of_half_the_angle(step):
    """Show that q + h H omega / 2, normalised, turns by 2 atan(omega h / 2) about omega."""
    rate = np.linalg.norm(OMEGA)
    angle = round(DURATION / step) * 2 * np.arctan(rate * step / 2)
    q, _ = spun('explicit_euler', step)
    assert rotation_distance(q, Rotation.from_rotvec(angle * OMEGA / rate)) < 1e-13


@pytest.mark.parametrize('step', [0.1, 0.01])
@pytest.mark.parametrize('method', ['explicit_euler_axis_angle', 'semi_implicit_euler'])
def test_the_axis_angle_update_is_exact_for_constant_omega(method, step):
    q, _ = spun(method, step)
    assert rotation_distance(q, Rotation.from_rotvec(OMEGA * DURATION)) < 1e-13


def test_normalisation_removes_what_a_step_of_the_h_update_adds():
    q, simulator = spun('explicit_euler', 0.01)
    grown = np.sqrt(1 + (np.linalg.norm(OMEGA) * 0.01 / 2) ** 2) - 1
    assert simulator.normalisation_removed == pytest.approx(100 * grown, rel=1e-9)
    assert np.linalg.norm(q) == pytest.approx(1.0, abs=3e-16)


@pytest.mark.parametrize('method', ['explicit_euler_axis_angle', 'semi_implicit_euler'])
def test_the_axis_angle_update_leaves_nothing_to_normalise(method):
    _, simulator = spun(method, 0.01)
    assert simulator.normalisation_removed < 100 * 5e-16


def test_both_updates_agree_to_second_order_in_a_tumbling_box():
    """Their errors of order 1 are the same, from omega; they part with the square of the step."""
    scene = with_values(load_scene('spinning_box'), {'box.angular_velocity': (3, 6, -2)})
    gaps = []
    for step in (2e-3, 1e-3, 5e-4):
        by_h, _ = spun('explicit_euler', step, scene)
        by_axis_angle, _ = spun('explicit_euler_axis_angle', step, scene)
        gaps.append(rotation_distance(by_h, rotation_of(by_axis_angle)))
    np.testing.assert_allclose(np.log2(np.divide(gaps[:-1], gaps[1:])), 2.0, atol=0.1)
