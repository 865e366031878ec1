# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Quantities change while running: as a group, whole or not at all."""

from dynsim_ros.scene import Box, load_scene, Scene, SceneError, with_values
from dynsim_ros.simulation import SetValues, Simulator
import numpy as np
import pytest

SCENE = load_scene('sphere_on_spring')


@pytest.mark.parametrize('method, near', [('rk4', 0.0), ('auto', 1e-9)])
def test_a_group_takes_effect_at_once_and_leaves_the_motion_where_it_is(method, near):
    """To the bit; where the method chooses its steps, within its tolerance: one ends there."""
    simulator = Simulator(SCENE, integrator=method)
    simulator.run(0.3)
    before = simulator.snapshot()
    simulator.apply(SetValues({'spring.stiffness': 200, 'gravity': 1.6, 'sphere.mass': 2,
                               'air.velocity': [1, 0, 0], 'integrator': 'semi_implicit_euler'}))
    after = simulator.snapshot()
    np.testing.assert_allclose(after.state, before.state, rtol=0.0, atol=near)
    np.testing.assert_allclose(after.wrench('gravity', 'sphere')[0], (0, 0, -3.2))
    np.testing.assert_allclose(after.wrench('spring', 'sphere')[0],
                               2 * before.wrench('spring', 'sphere')[0])
    np.testing.assert_allclose(
        after.wrench('air', 'sphere')[0] - before.wrench('air', 'sphere')[0], (0.1, 0, 0),
        atol=1e-16 + near)
    assert simulator.settings.integrator == 'semi_implicit_euler'


@pytest.mark.parametrize('wrong, words', [
    ({'sphere.mas': 1}, "'sphere.mas' is no quantity of this scene and no setting; did you mean "
                        "'sphere.mass'?"),
    ({'sphere.mass': -1}, r'sphere.mass: -1 kg is out of range: 1e-09 to 1e\+06 kg'),
    ({'sphere.mass': float('nan')}, 'sphere.mass: nan is not finite; give a number in kg'),
    ({'sphere.mass': None}, 'sphere.mass: None is not a number'),
    ({'gravity': None}, 'gravity: None is not a number'),
    ({'sphere.mass': True}, 'sphere.mass: True is not a number'),
    ({'sphere.mass': 'heavy'}, "sphere.mass: 'heavy' is not a number"),
    ({'sphere.mass': 10 ** 400}, 'sphere.mass: inf is not finite'),
    ({'sphere.mass': [1, 2]}, r'sphere.mass: \[1, 2\] is not a number'),
    ({'sphere.mass': np.array([1.0, 2.0])}, 'sphere.mass: .* is not one number'),
    ({'sphere.position': [0, 0, 0]}, 'sphere.position: is an initial condition'),
    ({'down': [0, 0, 0]}, 'down: .* has no direction'),
    ({'integrator': 'rk5'}, "integrator: 'rk5' is not known; did you mean 'rk4'?"),
    ({'integrator': ['rk4']}, 'integrator: .* is not known'),
    ({'anchor_interpolation': 'cubic'}, "anchor_interpolation: 'cubic' is not known"),
    ({'rate': 0}, 'rate: 0 Hz is out of range: 0.1 to 10000 Hz'),
    ({'step': 2}, 'step: 2 s is out of range: 1e-07 to 1 s'),
    ({'wrench_timeout': -1}, 'wrench_timeout: -1 s is out of range')])
def test_one_wrong_value_refuses_the_whole_group_and_changes_no_bit(wrong, words):
    simulators = [Simulator(SCENE), Simulator(SCENE)]
    for simulator in simulators:
        simulator.advance(100_300_000)
    with pytest.raises(SceneError, match=words) as caught:
        simulators[0].apply(SetValues({'spring.stiffness': 200, **wrong, 'step': 0.002}
                                      if 'step' not in wrong else {'gravity': 1, **wrong}))
    assert '\n' not in str(caught.value)
    assert simulators[0].scene == SCENE
    assert simulators[0].settings == simulators[1].settings
    for simulator in simulators:
        simulator.advance(100_300_000)
    assert simulators[0].snapshot().state.tobytes() == simulators[1].snapshot().state.tobytes()
    assert simulators[0].snapshot().energy == simulators[1].snapshot().energy


def boxes():
    return Scene(bodies=(
        Box(name='first', mass=1, size=(0.3, 0.3, 0.3), position=(1, 2, 3),
            velocity=(0.1, 0.2, 0.3), angular_velocity=(1, 2, 3)),
        Box(name='second', mass=2, size=(0.1, 0.2, 0.3), position=(4, 5, 6),
            angular_velocity=(-1, 0.5, 2))))


def state_of(simulator, body):
    snapshot = simulator.snapshot()
    return np.concatenate([snapshot.position(body), snapshot.velocity(body),
                           snapshot.orientation(body), snapshot.angular_velocity(body)])


def test_a_cube_that_becomes_a_box_keeps_the_states_of_all_bodies():
    """It gets Euler's full equation then, and loses it when it is a cube again."""
    simulator = Simulator(boxes(), integrator='rk4')
    simulator.run(0.2)
    before = [state_of(simulator, body).tobytes() for body in ('first', 'second')]
    for size, is_round in (([0.3, 0.3, 0.9], False), ([0.2, 0.2, 0.2], True)):
        simulator.apply(SetValues({'first.size': size}))
        assert [state_of(simulator, body).tobytes() for body in ('first', 'second')] == before
        omega = simulator.snapshot().angular_velocity('first')
        simulator.run(0.2)
        unchanged = np.array_equal(simulator.snapshot().angular_velocity('first'), omega)
        assert unchanged is is_round
        before = [state_of(simulator, body).tobytes() for body in ('first', 'second')]


def test_values_come_back_as_they_are_in_force():
    simulator = Simulator(load_scene('sphere_on_spring'))
    command = simulator.apply(SetValues({
        'spring.stiffness': '2e2', 'down': (0, 0, -2), 'rate': 50, 'integrator': 'rk4'}))
    assert command == SetValues({
        'spring.stiffness': 200.0, 'down': [0.0, 0.0, -1.0], 'rate': 50.0, 'integrator': 'rk4'})


def test_an_anchor_that_is_put_elsewhere_goes_on_and_does_work():
    scene = with_values(load_scene('particle_on_spring'), {'hand.velocity': (0.5, 0, 0)})
    simulator = Simulator(scene, integrator='rk4', step=1e-4)
    simulator.run(0.1)
    simulator.apply(SetValues({'hand.position': (0, 0, 2.5)}))
    np.testing.assert_allclose(simulator.snapshot().anchors, [[0, 0, 2.5, 0.5, 0, 0]])
    energy = simulator.run(0.1).snapshots[-1].energy
    assert energy.work['anchor'] > 1.0
    np.testing.assert_allclose(energy.imbalance, 0.0, atol=1e-9)
