# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A run that has come to rest takes no more steps, until something happens to it."""

from by_hand import nothing_compiled
from dynsim_ros.integrators.closed_scene import comes_to_rest
from dynsim_ros.physics.drive import undisturbed_drive
from dynsim_ros.physics.model import build_model
from dynsim_ros.physics.state import initial_state
from dynsim_ros.scene import parse_scene
from dynsim_ros.simulation import MoveAnchor, PushBody, SetValues, Simulator
import numpy as np
import pytest
from simulated import samples

TOLERANCE = 1e-9
SPHERE = """
gravity: 9.81
air: {linear_drag: 2.0, rotational_drag: 0.01}
anchors: {hand: {position: [0, 0, 2]}}
bodies:
  ball: {shape: sphere, mass: 1, radius: 0.1, position: [0.3, 0, 1.2], velocity: [0, 0.5, 0],
         angular_velocity: [1, 2, 3]}
springs: {spring: {from: hand, to: ball, stiffness: 100, damping: 3, natural_length: 0.5}}"""
START = 'position: [0.3, 0, 1.2], velocity: [0, 0.5, 0],\n         angular_velocity: [1, 2, 3]'
HANGING = 2 - 0.5 - 9.81 / 100 - 0.1


def test_falls_asleep_where_it_hangs():
    simulator = Simulator(parse_scene(SPHERE), tolerance=TOLERANCE, rate=1)
    simulator.run(300.0)
    end, taken = simulator.snapshot().state, simulator.counts
    np.testing.assert_allclose(end[:3], [0, 0, HANGING], rtol=0, atol=TOLERANCE)
    np.testing.assert_allclose(end[3:6], 0, atol=1e-2 * TOLERANCE)
    simulator.run(2700.0)
    np.testing.assert_array_equal(simulator.snapshot().state, end)
    assert simulator.counts == taken


def test_as_without_sleep():
    scene = parse_scene(SPHERE)
    asleep, awake = (samples(scene, 200.0, 10.0, tolerance=TOLERANCE, integrator=method)[0]
                     for method in ('auto', 'extrapolation'))
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
    with nothing_compiled():
        simulator.apply(command)
        simulator.run(0.2)
    assert np.abs(simulator.snapshot().state - held)[:6].max() > 1e-4


@pytest.mark.parametrize('change', [
    ('linear_drag: 2.0', 'linear_drag: 1.0e-3'),
    ('rotational_drag: 0.01', 'rotational_drag: 1.0e-7'),
    ('position: [0, 0, 2]', 'position: [0, 0, 2], velocity: [1e-12, 0, 0]')])
def test_what_may_move_on_is_not_held(change):
    """Hardly any air to stop it, a spin that goes on for days, an anchor that creeps."""
    assert change[0] in SPHERE
    scene = parse_scene(SPHERE.replace(*change))
    states, _ = samples(scene, 400.0, 1.0, tolerance=TOLERANCE)
    assert (states[-1, :13] != states[-2, :13]).any()


@pytest.mark.parametrize('change', [
    ('linear_drag: 2.0', 'linear_drag: 0'), ('rotational_drag: 0.01', 'rotational_drag: 0'),
    ('rotational_drag: 0.01', 'rotational_drag: 0.01, angular_velocity: [0, 0, 1]')])
def test_where_the_air_does_not_stop_it_nothing_is_held(change):
    assert change[0] in SPHERE and lasts(SPHERE)
    assert not lasts(SPHERE.replace(*change))


def lasts(text):
    """Tell whether a scene may be held where it hangs."""
    scene = parse_scene(text.replace(START, f'position: [0, 0, {HANGING}]'))
    model = build_model(scene)
    return comes_to_rest(model, undisturbed_drive(scene), initial_state(scene, model), 100.0,
                         1e-10)


@pytest.mark.parametrize('place, is_held', [
    (f'position: [0, 0, {HANGING}]', True),
    ('position: [0, 0, 2.5019], orientation: {axis: [1, 0, 0], angle: 3.141592653589793}', False)])
def test_below_the_anchor_and_on_top_of_it(place, is_held):
    assert lasts(SPHERE.replace(START, place)) == is_held


BEAD = """
air: {linear_drag: 1}
anchors: {left: {position: [-1, 0, 0]}, right: {position: [1, 0, 0]}}
bodies:
  bead: {shape: particle, mass: 1, position: [0, %g, 0]}
  loose: {shape: particle, mass: 1, position: [0, 0, 1]}
springs:
  a: {from: left, to: bead, stiffness: %g, natural_length: 0.5}
  b: {from: right, to: bead, stiffness: %g, natural_length: 0.5}"""


def crept(displacement, stiffness, tolerance, duration):
    """Return where drag lets the bead creep to, and where it has to be in closed form [m]."""
    simulator = Simulator(parse_scene(BEAD % (displacement, stiffness, stiffness)),
                          tolerance=tolerance, rate=0.1)
    simulator.run(duration)
    # Both springs are twice as long as by nature: half of their stiffness acts across them.
    root = np.sqrt(1.0 - 4.0 * stiffness)
    slow, fast = -2.0 * stiffness / (1.0 + root), -0.5 * (1.0 + root)
    return simulator.snapshot().position('bead')[1], displacement / (slow - fast) * (
        slow * np.exp(fast * duration) - fast * np.exp(slow * duration))


@pytest.mark.parametrize('displacement, stiffness, tolerance', [
    (1e-3, 1e-6, 1e-3), (1e-7, 1e-4, 1e-9), (1e-7, 1e-6, 1e-9)])
def test_what_creeps_is_not_held(displacement, stiffness, tolerance):
    """Strong drag makes slow what soft springs still move far."""
    for duration in (1e2, 1e4, 1e5):
        found, expected = crept(displacement, stiffness, tolerance, duration)
        assert abs(found - expected) <= tolerance


@pytest.mark.parametrize('displacement, is_held', [(1e-11, True), (1e-9, False)])
def test_what_has_crept_home_is_held(displacement, is_held):
    assert lasts(BEAD % (displacement, 1e-3, 1e-3)) == is_held


@pytest.mark.parametrize('displacement, is_held', [(1e-11, True), (1e-9, False)])
def test_all_bodies_have_to_be_near_where_they_come_to_rest(displacement, is_held):
    """Springs of one do not hold another, however stiff they are."""
    bodies, springs = (BEAD % (1e-11, 1e3, 1e3)).split('springs:')
    soft = ''.join(f"""
  {name}: {{from: {anchor}, to: slow, stiffness: 1.0e-3, natural_length: 0.5}}"""
                   for name, anchor in (('c', 'left'), ('d', 'right')))
    assert lasts(f'{bodies}  slow: {{shape: particle, mass: 1, position: [0, {displacement}, 0]}}'
                 f'\nsprings:{springs}{soft}') == is_held


@pytest.mark.parametrize('force, tolerance', [(5e-6, 1e-3), (5e-12, TOLERANCE)])
def test_what_is_pushed_is_not_held(force, tolerance):
    simulator = Simulator(parse_scene(BEAD % (0.0, 1e-3, 1e-3)), tolerance=tolerance, rate=1,
                          wrench_timeout=0.0)
    simulator.apply(PushBody('loose', (force, 0, 0)))
    simulator.run(2e4)
    assert abs(simulator.snapshot().position('loose')[0] - force * (2e4 - 1.0)) <= tolerance
