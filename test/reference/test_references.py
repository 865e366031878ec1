# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Every scene of the package against a trajectory that was not computed by it.

How references.json came about, and how it was verified, is in make_references.py.
"""

from dynsim_ros.scene import load_scene, scene_names
from dynsim_ros.simulation import Simulator
from dynsim_ros.simulation.layout import Layout
from newton_euler import rotation_of
import numpy as np
import pytest
from references import all_scenes, angle, error, load, scenes, State


def test_there_is_one_for_every_scene():
    assert scenes() == list(all_scenes())
    assert set(scene_names()) < set(scenes())


@pytest.mark.parametrize('name', scenes())
def test_it_tells_every_part_of_every_body(name):
    scene, times, motions = load(name)
    assert len(times) == len(motions) == 5
    for motion in motions:
        assert {body: len(parts) for body, parts in motion.items()} == {
            body.name: 4 if hasattr(body, 'orientation') else 2 for body in scene.bodies}


@pytest.mark.parametrize('name', scene_names())
def test_scene_follows_its_reference(name):
    scene, times, motions = load(name)
    simulator = Simulator(scene, step=2e-5, integrator='rk4')
    for time, motion in zip(times, motions):
        simulator.advance(round(time * 1e9) - simulator.time_ns)
        assert error(simulator.snapshot(), motion) < 1e-10


@pytest.mark.parametrize('name', scene_names())
def test_the_default_step_is_fine_enough_to_look_at(name):
    """Within a tenth of a millimetre at the first time of the reference."""
    _, times, motions = load(name)
    simulator = Simulator(load_scene(name), integrator='rk4')
    simulator.advance(round(times[0] * 1e9))
    for body, (r, *_) in motions[0].items():
        np.testing.assert_allclose(simulator.snapshot().position(body), r, atol=1e-4)


def test_error_is_the_largest_of_all_parts_over_their_size():
    scene, _, motions = load('S2')
    layout, (r, v, q, omega) = Layout(scene), motions[0]['ball']
    y = np.zeros(layout.size)

    def changed(place=None, by=0.0):
        for part, value in (('position', r), ('velocity', v), ('orientation', -3.0 * q),
                            ('angular_velocity', omega)):
            y[getattr(layout, part)('ball')] = value
        if place is not None:
            y[getattr(layout, place)('ball')] += by
        return error(State(layout, y), motions[0])
    assert changed() < 1e-15
    assert changed('position', (3e-6, 0, 4e-6)) == pytest.approx(
        5e-6 / max(1, np.linalg.norm(r)))
    assert changed('velocity', (0, -5e-9, 0)) == pytest.approx(5e-9 / max(1, np.linalg.norm(v)))
    assert changed('angular_velocity', 1e-3) == pytest.approx(
        np.sqrt(3e-6) / max(1, np.linalg.norm(omega)))
    assert changed('orientation', 6.0 * q) < 1e-15
    assert np.isnan(changed('orientation', np.nan))


@pytest.mark.parametrize('turn', [0.0, 1e-14, 1e-9, 1e-3, 1.0, 3.0, np.pi])
def test_angle_is_exact_for_small_turns_too(turn):
    p = np.array([0.5, -0.1, 0.7, 0.5])
    x, y, z, w = (rotation_of(p) * rotation_of(
        [np.cos(turn / 2), *(np.sin(turn / 2) * np.array([0.6, 0, -0.8]))])).as_quat()
    assert angle(np.array([w, x, y, z]), p) == pytest.approx(turn, abs=4e-16, rel=1e-14)
