# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Commanded wrenches: what they do, for how long, and what is refused."""

from dynsim_ros.scene import load_scene, with_values
from dynsim_ros.simulation import CommandError, PushBody, Simulator
from newton_euler import NewtonEuler
import numpy as np
import pytest

FREE = with_values(load_scene('particle_on_spring'), {
    'gravity': 0, 'spring.stiffness': 0, 'particle.mass': 2, 'particle.position': (0, 0, 0),
    'particle.velocity': (0, 0, 0)})


@pytest.mark.parametrize('method, rounding', [('rk4', 1e-13), ('auto', 1e-12)])
def test_a_push_ends_on_the_nanosecond_of_its_timeout(method, rounding):
    """Not at a tick, not at a step."""
    simulator = Simulator(FREE, integrator=method, rate=30, wrench_timeout=0.123456789)
    simulator.run(0.05)
    start = simulator.time_ns
    simulator.apply(PushBody('particle', (4, 0, 0)))
    simulator.run(1.0)
    time, coasting = 0.123456789, (simulator.time_ns - start) * 1e-9 - 0.123456789
    end = simulator.snapshot()
    np.testing.assert_allclose(end.velocity('particle'), (2 * time, 0, 0), rtol=rounding)
    np.testing.assert_allclose(end.position('particle'),
                               (time ** 2 + 2 * time * coasting, 0, 0), rtol=rounding)
    assert end.energy.work['push'] == pytest.approx(0.5 * 2 * (2 * time) ** 2, rel=1e-12)


def test_timeout_is_seen_at_its_very_instant():
    simulator = Simulator(FREE, wrench_timeout=0.1)
    simulator.apply(PushBody('particle', (4, 0, 0)))
    simulator.advance(99_999_999)
    assert simulator.snapshot().wrench('net', 'particle')[0][0] == 4.0
    simulator.advance(1)
    assert simulator.snapshot().wrench('net', 'particle')[0][0] == 0.0


def test_a_push_is_replaced_and_its_timeout_begins_anew():
    simulator = Simulator(FREE, wrench_timeout=0.1)
    for force in (4, 2):
        simulator.apply(PushBody('particle', (force, 0, 0)))
        simulator.advance(80_000_000)
    simulator.run(0.5)
    expected = (4 * 0.08 + 2 * 0.1) / 2
    assert simulator.snapshot().velocity('particle')[0] == pytest.approx(expected, rel=1e-13)


def test_timeout_zero_pushes_until_replaced():
    simulator = Simulator(FREE, wrench_timeout=0)
    simulator.apply(PushBody('particle', (4, 0, 0)))
    simulator.run(3.0)
    simulator.apply(PushBody('particle', (0, 0, 0)))
    simulator.run(1.0)
    assert simulator.snapshot().velocity('particle')[0] == pytest.approx(6.0, rel=1e-12)


@pytest.mark.parametrize('method', [{'integrator': 'rk4', 'step': 5e-5},
                                    {'integrator': 'auto', 'tolerance': 1e-12}])
def test_force_and_torque_agree_with_newton_euler(method):
    scene, push = load_scene('sphere_on_spring'), ((1.0, -2.0, 3.0), (0.01, 0.02, -0.03))
    simulator = Simulator(scene, wrench_timeout=0, **method)
    simulator.apply(PushBody('sphere', *push))
    simulator.run(0.5)
    r, v, _, omega = NewtonEuler(scene, {'sphere': push}).solve([0.5])[0]['sphere']
    np.testing.assert_allclose(simulator.snapshot().position('sphere'), r, atol=1e-11)
    np.testing.assert_allclose(simulator.snapshot().velocity('sphere'), v, atol=1e-10)
    np.testing.assert_allclose(simulator.snapshot().angular_velocity('sphere'), omega, atol=1e-9)


@pytest.mark.parametrize('command, words', [
    (PushBody('particl', (1, 0, 0)), "'particl' is no body of this scene; did you mean 'parti"),
    (PushBody('hand', (1, 0, 0)), "'hand' is no body"),
    (PushBody('particle', (1, 0, float('nan'))), r'force\[2\]: nan is not finite'),
    (PushBody('particle', (2e9, 0, 0)), r'2e\+09 N is out of range: -1e\+09 to 1e\+09 N'),
    (PushBody('particle', (1, 0, 0), (0, 0, 1)),
     r'particle: torque \[0.0, 0.0, 1.0\] N m cannot act on a particle.*give a force only'),
    ('push', "'push' is no command")])
def test_a_wrong_command_is_refused_and_changes_no_bit(command, words):
    simulator = Simulator(FREE)
    before = simulator.snapshot()
    with pytest.raises(CommandError, match=words):
        simulator.apply(command)
    assert simulator.snapshot().state.tobytes() == before.state.tobytes()
    assert simulator.snapshot().pushes.tobytes() == before.pushes.tobytes()
