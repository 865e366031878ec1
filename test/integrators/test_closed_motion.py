# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes whose motion has a closed form are not integrated by `auto`, and exact."""

from dynsim_ros.integrators import stepping
from dynsim_ros.scene import load_scene, parse_scene, with_values
from dynsim_ros.simulation import Propagator, Simulator
from dynsim_ros.simulation.commands import MoveAnchor, PushBody, SetValues
from integrators.closed_form.exact import (angle_between, error, linear_motion, TextbookTop,
                                           turn_about)
import mpmath as mp
from newton_euler import NewtonEuler, rotation_distance
import numpy as np
import pytest
import references
from scipy.spatial.transform import Rotation

SECOND = 10 ** 9
NAMES = ['at_rest', 'falling_in_wind', 'free_spin', 'no_natural_length', 'spinning_box',
         'up_and_down']


@pytest.fixture(autouse=True)
def no_steps(monkeypatch):
    """Whoever asks for steps fails."""
    def refuse(*_):
        raise AssertionError('the motion is integrated')
    monkeypatch.setattr(stepping, 'AutoSteps', refuse)


def imbalance(simulator):
    """Return the imbalance of the energy over the largest of its terms."""
    energy = simulator.snapshot().energy
    return abs(energy.imbalance) / max(energy.kinetic, abs(energy.gravitational), energy.spring,
                                       *map(abs, energy.work.values()))


@pytest.mark.parametrize('name', NAMES)
def test_scene_follows_its_reference(name):
    scene, times, motions = references.load(name)
    simulator = Simulator(scene)
    for time, motion in zip(times, motions):
        simulator.advance(round(time * SECOND) - simulator.time_ns)
        assert references.error(simulator.snapshot(), motion) < 1e-14
        assert imbalance(simulator) < 1e-14


def test_propagator_gives_the_same_states_at_no_cost():
    scene, times, motions = references.load('free_flight')
    propagator = Propagator(scene)
    layout = Simulator(scene).layout
    states = propagator.samples(10.0, 1000.0)
    for time, motion in zip(times, motions):
        state = propagator.end_state(time)
        assert references.error(references.State(layout, state), motion) < 1e-15
        np.testing.assert_array_equal(states[round(time * 1000)], state)
    np.testing.assert_array_equal(states[0], propagator.end_state(0.0))
    assert propagator.counts == dict.fromkeys(
        ('steps', 'rejected', 'evaluations', 'rounded'), 0)


def motion_at(scene, time_ns):
    simulator = Simulator(scene)
    simulator.advance(time_ns)
    return simulator.snapshot()


def test_spin_of_ball_and_box_for_hours():
    scene = references.all_scenes()['free_spin']
    for time_ns in (10_000 * SECOND, 9_876_543_210_123):
        now = motion_at(scene, time_ns)
        with mp.workdps(40):
            t = mp.mpf(time_ns) / SECOND
            assert angle_between(now.orientation('ball'), turn_about([3 * t, -4 * t, 12 * t])) < (
                1e-15)
            box = scene.bodies[[body.name for body in scene.bodies].index('box')]
            index = now.layout.bodies.index('box')
            moments = np.diag(now.model.inertia[now.model.general_body.tolist().index(index)])
            order = np.argsort(moments)
            assert order.tolist() == [2, 1, 0]
            # the textbook's axes are those of ascending moments: the box turned about its y axis
            turned = mp.matrix([[0, 0, 1], [0, 1, 0], [-1, 0, 0]])
            top = TextbookTop(moments[order], (1.0, 0.0, 0.0, 0.0),
                              list(turned.T * mp.matrix(box.angular_velocity)))
            matrix, omega = top.at(t)
            assert angle_between(now.orientation('box'), turned * matrix * turned.T) < 3e-15
            assert error(now.angular_velocity('box'), list(turned * omega)) < 3e-15


def test_swing_for_hours():
    scene = with_values(references.all_scenes()['no_natural_length'], {'air.linear_drag': 0})
    for time_ns in (10_000 * SECOND, 9_876_543_210_123):
        now = motion_at(scene, time_ns)
        with mp.workdps(60):
            t = mp.mpf(time_ns) / SECOND
            g, k, m = (0, 0, -mp.mpf(9.81)), mp.mpf(50), mp.mpf(0.8)
            velocity = [mp.mpf(v) for v in (0.3, 0.0, -0.2)]
            parts = [linear_motion(t, mp.mpf(r) - c, mp.mpf(v) - u, 0, k / m, a)
                     for r, v, c, u, a in zip((0.5, 0, 2.3), (0, 1.5, 0), (0, 0, 2), velocity, g)]
            position = [y + c + u * t for (y, _), c, u in zip(parts, (0, 0, 2), velocity)]
            assert error(now.position('dot'), position) < 1e-15
            assert error(now.velocity('dot'), [v + u for (_, v), u in zip(parts, velocity)]) < (
                1e-14)


def test_bounce_for_hours():
    scene = with_values(references.all_scenes()['up_and_down'], {
        'air.linear_drag': 0, 'air.rotational_drag': 0, 'spring.damping': 0})
    time_ns = 9_876_543_210_123
    now = motion_at(scene, time_ns)
    with mp.workdps(60):
        t = mp.mpf(time_ns) / SECOND
        start = mp.mpf(3) - mp.mpf(1.9) - mp.mpf(0.1)
        length, rate = linear_motion(t, start, mp.mpf(0.2) + 1, 0, mp.mpf(60) / mp.mpf(0.6),
                                     mp.mpf(9.81) + mp.mpf(60) / mp.mpf(0.6) * mp.mpf(0.8))
        height = 3 + mp.mpf(0.2) * t - length - mp.mpf(0.1)
        assert error(now.position('ball'), (0.5, 0.5, height)) < 1e-15
        assert abs(now.velocity('ball')[2] - (mp.mpf(0.2) - rate)) < 1e-13
        assert angle_between(now.orientation('ball'), turn_about((0, 0, 15 * t))) < 1e-15


@pytest.mark.parametrize('name', NAMES)
def test_quaternions_turn_without_a_jump(name):
    simulator = Simulator(references.all_scenes()[name], rate=1000.0)
    states = np.array([snapshot.state for snapshot in simulator.run(3.0).snapshots])
    layout = simulator.layout
    for body in layout.bodies[:layout.rigid]:
        q = states[:, layout.orientation(body)]
        assert np.abs(np.diff(q, axis=0)).max() < 0.02
        np.testing.assert_allclose(np.linalg.norm(q, axis=1), 1.0, atol=1e-15)


def test_a_push_in_mid_flight():
    """Where it begins and where it ends another closed form begins."""
    simulator = Simulator(load_scene('falling_in_wind'), wrench_timeout=0.4)
    simulator.advance(500_000_000)
    simulator.apply(PushBody(body='ball', force=(3, 0, -1), torque=(1e-4, 0, 0)))
    r, v = (0, 0, 1), (1, 0, 8)
    with mp.workdps(50):
        rate = mp.mpf(0.2) / mp.mpf(0.2)
        for duration, force in ((0.5, (0, 0, 0)), (0.4, (3, 0, -1)), (0.7, (0, 0, 0))):
            parts = [linear_motion(mp.mpf(str(duration)), *start, rate, 0,
                                   f / mp.mpf(0.2) + g + rate * w)
                     for *start, f, g, w in zip(r, v, force, (0, 0, -mp.mpf(9.81)), (3, 1, 0))]
            r, v = zip(*parts)
        simulator.advance(1_100_000_000)
        now = simulator.snapshot()
        assert error(now.position('ball'), r) < 2e-15
        assert error(now.velocity('ball'), v) < 2e-15
    assert imbalance(simulator) < 1e-14


def test_a_torque_against_the_equations_of_motion_solved_by_scipy():
    scene = load_scene('falling_in_wind')
    force, torque = (0.1, 0.2, 0.3), (1e-3, -2e-3, 5e-4)
    simulator = Simulator(scene, wrench_timeout=0)
    simulator.apply(PushBody(body='ball', force=force, torque=torque))
    simulator.advance(SECOND)
    now = simulator.snapshot()
    _, v, matrix, omega = NewtonEuler(scene, {'ball': (force, torque)}).solve([1.0])[0]['ball']
    np.testing.assert_allclose(now.velocity('ball'), v, atol=1e-11)
    np.testing.assert_allclose(now.angular_velocity('ball'), omega, atol=1e-11)
    assert rotation_distance(now.orientation('ball'), Rotation.from_matrix(matrix)) < 1e-11


def test_who_looks_and_when_changes_no_bit():
    ends = []
    for pieces in ([3 * SECOND], [SECOND, 1, 7, 2 * SECOND - 8], [10 ** 8] * 30):
        simulator = Simulator(references.all_scenes()['free_spin'])
        for piece in pieces:
            simulator.advance(piece)
        ends.append(simulator.snapshot().state)
    for end in ends[1:]:
        np.testing.assert_array_equal(end, ends[0])


def test_a_command_that_changes_nothing_leaves_the_motion():
    scene = references.all_scenes()['free_spin']
    simulator = Simulator(scene)
    for _ in range(200):
        simulator.advance(10 ** 7)
        simulator.apply(PushBody(body='box', force=(0, 0, 0), torque=(0, 0, 0)))
    whole = motion_at(scene, 2 * SECOND)
    np.testing.assert_allclose(simulator.snapshot().state, whole.state, atol=1e-12)
    assert imbalance(simulator) < 1e-13


def test_values_set_and_anchors_moved():
    simulator = Simulator(references.all_scenes()['no_natural_length'],
                          anchor_interpolation='linear')
    for tick in range(100):
        if tick % 7 == 3:
            simulator.apply(MoveAnchor(anchor='hand', position=(0.1 * tick, 1, 2)))
        if tick == 50:
            simulator.apply(SetValues({'dot.mass': 1.5, 'spring.stiffness': 80}))
        simulator.advance_tick()
        assert imbalance(simulator) < 1e-13


def moving_scenes():
    """Yield scenes in which all works but that of pushes occur, and what pushes the body."""
    up_and_down = references.all_scenes()['up_and_down']
    yield up_and_down, 'ball', (0, 0, 2.0), (0, 0, 1e-4)
    yield load_scene('falling_in_wind'), 'ball', (0.3, 0.2, -1), (1e-3, 0, 0)
    yield parse_scene("""
gravity: 9.81
air: {linear_drag: 0.4, velocity: [1, -2, 0.5]}
anchors:
  one: {position: [0, 0, 2], velocity: [0.1, 0, 0.4]}
  two: {position: [1, 0, 0], velocity: [0, 0.3, 0]}
bodies: {dot: {shape: particle, mass: 0.7, position: [0.3, -2, 1.2], velocity: [1, 0.5, -3]}}
springs:
  a: {from: one, to: dot, stiffness: 20, natural_length: 0}
  b: {from: dot, to: two, stiffness: 5, natural_length: 0}"""), 'dot', (1, 2, -0.5), None


def powers(scene, now, body, force, torque):
    """Return the powers of damper, air, anchors and pushes, from the scene's own numbers [W]."""
    r, v, air = now.position(body), now.velocity(body), scene.air
    found = {'damper': 0.0, 'anchor': 0.0, 'push': v @ force,
             'air': -(air.linear_drag or 0.0) * v @ (v - air.velocity)}
    arm = np.zeros(3)
    if torque is not None:
        omega = now.angular_velocity(body)
        found['push'] += omega @ torque
        found['air'] -= air.rotational_drag * omega @ (omega - air.angular_velocity)
        arm = (0, 0, scene.bodies[0].radius)
    for spring in scene.springs:
        anchor = spring.to if spring.from_ == body else spring.from_
        gap = r + arm - now.anchor_position(anchor)
        length, velocity = np.linalg.norm(gap), now.anchor_velocity(anchor)
        rate = (v - velocity) @ gap / length
        damping = (spring.damping or 0.0) * rate
        found['damper'] -= damping * rate
        pull = spring.stiffness * (length - spring.natural_length) + damping
        found['anchor'] -= pull * gap @ velocity / length
    return np.array([found[name] for name in ('damper', 'air', 'anchor', 'push')])


@pytest.mark.parametrize('scene, body, force, torque', moving_scenes(),
                         ids=['line', 'flight', 'centred'])
def test_each_work_is_the_integral_of_its_power(scene, body, force, torque):
    simulator = Simulator(scene, wrench_timeout=0)
    simulator.apply(PushBody(body=body, force=force, torque=torque or (0, 0, 0)))
    works, panel = np.zeros(4), SECOND // 20
    nodes, weights = np.polynomial.legendre.leggauss(10)
    for start in range(0, 2 * SECOND, panel):
        for node, weight in zip(nodes, weights):
            simulator.advance(round(start + (node + 1) / 2 * panel) - simulator.time_ns)
            works += weight / 2 * panel / SECOND * powers(scene, simulator.snapshot(), body,
                                                          force, torque)
    simulator.advance(2 * SECOND - simulator.time_ns)
    energy = simulator.snapshot().energy
    np.testing.assert_allclose([*energy.work.values()], works, atol=1e-8)
    assert imbalance(simulator) < 1e-14
