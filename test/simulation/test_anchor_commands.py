# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Commanded anchors: hold or linear, on the nanosecond; their velocity enters the damper."""

from dynsim_ros.scene import load_scene, with_values
from dynsim_ros.simulation import CommandError, MoveAnchor, SetValues, Simulator
from newton_euler import NewtonEuler
import numpy as np
import pytest

SCENE = load_scene('sphere_on_spring')
TARGET = (0.1, 0.05, 2.0)


def test_hold_jumps_and_stands():
    simulator = Simulator(SCENE)
    simulator.run(0.2)
    simulator.apply(MoveAnchor('hand', TARGET))
    np.testing.assert_array_equal(simulator.snapshot().anchor_position('hand'), TARGET)
    np.testing.assert_array_equal(simulator.snapshot().anchor_velocity('hand'), 0)
    simulator.run(0.1)
    np.testing.assert_array_equal(simulator.snapshot().anchor_position('hand'), TARGET)


def test_linear_moves_evenly_for_a_tenth_of_a_second_and_arrives_exactly():
    simulator = Simulator(SCENE, anchor_interpolation='linear', rate=333)
    simulator.run(0.2)
    start = simulator.time_ns
    simulator.apply(MoveAnchor('hand', TARGET))
    velocity = (np.array(TARGET) - (0, 0, 2)) / 0.1
    np.testing.assert_allclose(simulator.snapshot().anchor_velocity('hand'), velocity, rtol=1e-14)
    simulator.advance(50_000_000)
    np.testing.assert_allclose(simulator.snapshot().anchor_position('hand'), (0.05, 0.025, 2),
                               rtol=1e-14)
    simulator.advance(start + 99_999_999 - simulator.time_ns)
    np.testing.assert_allclose(simulator.snapshot().anchor_velocity('hand'), velocity, rtol=1e-14)
    simulator.advance(1)
    np.testing.assert_array_equal(simulator.snapshot().anchor_position('hand'), TARGET)
    np.testing.assert_array_equal(simulator.snapshot().anchor_velocity('hand'), 0)


def test_linear_takes_as_long_as_since_the_command_before():
    simulator = Simulator(SCENE, anchor_interpolation='linear', rate=100)
    for number in range(1, 5):
        simulator.apply(MoveAnchor('hand', (0.01 * number, 0, 2)))
        simulator.advance(20_000_000)
    np.testing.assert_allclose(simulator.snapshot().anchor_velocity('hand'), (0, 0, 0))
    np.testing.assert_array_equal(simulator.snapshot().anchor_position('hand'), (0.04, 0, 2))
    simulator.apply(MoveAnchor('hand', (0.05, 0, 2)))
    np.testing.assert_allclose(simulator.snapshot().anchor_velocity('hand'), (0.5, 0, 0))


def test_two_commands_in_one_tick_move_for_one_tick():
    simulator = Simulator(SCENE, anchor_interpolation='linear', rate=100)
    simulator.apply(MoveAnchor('hand', (1, 0, 2)))
    simulator.apply(MoveAnchor('hand', (0, 0, 2.1)))
    np.testing.assert_allclose(simulator.snapshot().anchor_velocity('hand'), (0, 0, 10))


def test_velocity_of_the_anchor_enters_the_damper():
    """The sphere is at rest: dL/dt is the anchor's velocity away from it."""
    scene = with_values(SCENE, {'hand.velocity': (0.3, -0.2, 0.7), 'sphere.velocity': (0, 0, 0),
                                'sphere.angular_velocity': (0, 0, 0)})
    snapshot = Simulator(scene).snapshot()
    loads = NewtonEuler(scene)
    motion = loads.unpacked(loads.initial())
    gap = (loads.end('sphere', None, 0, motion)[0] - (0, 0, 2))
    u = gap / np.linalg.norm(gap)
    force, _ = snapshot.wrench('damper', 'sphere')
    np.testing.assert_allclose(force, 0.5 * (u @ (0.3, -0.2, 0.7)) * u, rtol=1e-14)


@pytest.mark.parametrize('method', [{'integrator': 'rk4', 'step': 5e-5},
                                    {'integrator': 'auto', 'tolerance': 1e-12}])
def test_commanded_motion_agrees_with_newton_euler(method):
    """Two linear moves and the rest after them, each piece by DOP853."""
    simulator = Simulator(SCENE, anchor_interpolation='linear', **method)
    for target in ((0.1, 0, 2.05), (0.1, 0.1, 1.95), (0.1, 0.1, 1.95)):
        start = simulator.snapshot()
        simulator.apply(MoveAnchor('hand', target))
        piece = with_values(SCENE, {
            'hand.position': start.anchor_position('hand'),
            'hand.velocity': simulator.snapshot().anchor_velocity('hand'),
            'sphere.position': start.position('sphere'),
            'sphere.velocity': start.velocity('sphere'),
            'sphere.orientation': np.roll(start.orientation('sphere'), -1),
            'sphere.angular_velocity': start.angular_velocity('sphere')})
        simulator.advance(100_000_000)
        r, v, _, omega = NewtonEuler(piece).solve([0.1])[0]['sphere']
        np.testing.assert_allclose(simulator.snapshot().position('sphere'), r, atol=1e-12)
        np.testing.assert_allclose(simulator.snapshot().velocity('sphere'), v, atol=1e-11)
        np.testing.assert_allclose(simulator.snapshot().angular_velocity('sphere'), omega,
                                   atol=1e-10)


def test_position_and_velocity_can_be_set():
    simulator = Simulator(SCENE)
    simulator.apply(SetValues({'hand.position': TARGET, 'hand.velocity': (0, 0, 1)}))
    simulator.advance(500_000_000)
    np.testing.assert_allclose(simulator.snapshot().anchor_position('hand'), (0.1, 0.05, 2.5),
                               rtol=1e-14)


@pytest.mark.parametrize('command, words', [
    (MoveAnchor('hnd', TARGET), "'hnd' is no anchor of this scene; did you mean 'hand'?"),
    (MoveAnchor('sphere', TARGET), "'sphere' is no anchor"),
    (MoveAnchor('hand', (0, float('nan'), 0)), r'position\[1\]: nan is not finite'),
    (MoveAnchor('hand', (0, 0, float('inf'))), r'position\[2\]: inf is not finite'),
    (MoveAnchor('hand', (0, 0)), 'is not a list of 3 numbers in m'),
    (MoveAnchor('hand', (0, 0, 2e6)), r'2000000 m is out of range: -1e\+06 to 1e\+06 m')])
def test_a_wrong_command_is_refused_and_changes_no_bit(command, words):
    simulators = [Simulator(SCENE), Simulator(SCENE)]
    for simulator in simulators:
        simulator.advance(100_300_000)
    with pytest.raises(CommandError, match=words):
        simulators[0].apply(command)
    for simulator in simulators:
        simulator.advance(100_300_000)
    assert len({s.snapshot().state.tobytes() + s.snapshot().anchors.tobytes()
                for s in simulators}) == 1
