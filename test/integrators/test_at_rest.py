# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A run that has come to rest takes no more steps, until something happens to it."""

from dynsim_ros.integrators.closed_scene import comes_to_rest
from dynsim_ros.physics.drive import undisturbed_drive
from dynsim_ros.physics.model import build_model
from dynsim_ros.physics.state import initial_state
from dynsim_ros.scene import parse_scene
from dynsim_ros.simulation import MoveAnchor, Propagator, PushBody, SetValues, Simulator
import numpy as np
import pytest

TOLERANCE = 1e-9
SPHERE = """
gravity: 9.81
air: {linear_drag: 2.0, rotational_drag: 0.01}
anchors: {hand: {position: [0, 0, 2]}}
bodies:
  ball: {shape: sphere, mass: 1, radius: 0.1, position: [0.3, 0, 1.2], velocity: [0, 0.5, 0],
         angular_velocity: [1, 2, 3]}
springs: {spring: {from: hand, to: ball, stiffness: 100, damping: 3, natural_length: 0.5}}"""
HANGING = 2 - 0.5 - 9.81 / 100 - 0.1


def steps(propagator):
    return propagator.counts['steps']


def test_falls_asleep_where_it_hangs():
    propagator = Propagator(parse_scene(SPHERE), tolerance=TOLERANCE)
    end = propagator.end_state(300.0)
    taken = steps(propagator)
    np.testing.assert_allclose(end[:3], [0, 0, HANGING], rtol=0, atol=TOLERANCE)
    np.testing.assert_allclose(end[3:6], 0, atol=1e-2 * TOLERANCE)
    np.testing.assert_array_equal(propagator.end_state(3000.0), end)
    assert steps(propagator) == taken


def test_as_without_sleep():
    scene = parse_scene(SPHERE)
    asleep = Propagator(scene, tolerance=TOLERANCE).samples(200.0, 10.0)
    awake = Propagator(scene, tolerance=TOLERANCE, integrator='extrapolation').samples(200.0, 10.0)
    np.testing.assert_allclose(asleep, awake, rtol=0, atol=10 * TOLERANCE)
    np.testing.assert_array_equal(asleep[-1], asleep[-100])
    assert (awake[-1] != awake[-100]).any()


def test_who_looks_changes_no_bit():
    scene = parse_scene(SPHERE)
    fine, coarse = (Simulator(scene, rate=rate) for rate in (100, 1))
    fine.run(250.0)
    coarse.run(250.0)
    np.testing.assert_array_equal(fine.snapshot().state, coarse.snapshot().state)


@pytest.mark.parametrize('command', [
    MoveAnchor('hand', (0.01, 0, 2)), PushBody('ball', (0, 0, 1)),
    SetValues({'spring.stiffness': 110}), SetValues({'hand.velocity': (0, 0.01, 0)}),
    SetValues({'air.velocity': (0.1, 0, 0)})], ids=lambda command: type(command).__name__)
def test_wakes(command):
    simulator = Simulator(parse_scene(SPHERE), rate=10)
    simulator.run(250.0)
    held = simulator.snapshot().state
    simulator.run(10.0)
    np.testing.assert_array_equal(simulator.snapshot().state, held)
    simulator.apply(command)
    simulator.run(0.2)
    assert np.abs(simulator.snapshot().state - held)[:6].max() > 1e-4


@pytest.mark.parametrize('change', [
    ('linear_drag: 2.0', 'linear_drag: 0'),
    ('rotational_drag: 0.01', 'angular_velocity: [0, 0, 1]'),
    ('position: [0, 0, 2]', 'position: [0, 0, 2], velocity: [1e-12, 0, 0]')])
def test_what_may_move_on_is_not_held(change):
    """No air to stop it, a spin that never ends, an anchor that creeps."""
    assert change[0] in SPHERE
    scene = parse_scene(SPHERE.replace(*change))
    states = Propagator(scene, tolerance=TOLERANCE).samples(40.0, 1.0)
    assert (states[-1, :13] != states[-2, :13]).any()


@pytest.mark.parametrize('place, lasts', [
    (f'position: [0, 0, {HANGING}]', True),
    ('position: [0, 0, 2.5019], orientation: {axis: [1, 0, 0], angle: 3.141592653589793}', False)])
def test_below_the_anchor_and_on_top_of_it(place, lasts):
    scene = parse_scene(SPHERE.replace(
        'position: [0.3, 0, 1.2], velocity: [0, 0.5, 0],\n         angular_velocity: [1, 2, 3]',
        place))
    model = build_model(scene)
    state = initial_state(scene, model)
    assert comes_to_rest(model, undisturbed_drive(scene), state, 100.0) == lasts
