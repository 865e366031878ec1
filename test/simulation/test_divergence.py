# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A run that is no longer finite stops, at its last finite state, and says why."""

from dynsim_ros.scene import load_scene, with_values
from dynsim_ros.simulation import DivergenceError, SetValues, Simulator
import numpy as np
import pytest


def diverged(method='rk4'):
    simulator = Simulator(load_scene('sphere_on_spring'), integrator=method, step=0.3)
    snapshots = [simulator.snapshot()]
    with pytest.raises(DivergenceError) as caught:
        while len(snapshots) < 10000:
            simulator.advance_tick()
            snapshots.append(simulator.snapshot())
    return simulator, snapshots, str(caught.value)


@pytest.mark.parametrize('method', ['rk4', 'explicit_euler'])
def test_nothing_that_is_seen_before_is_not_finite(method):
    """Neither states nor what is computed from them, however large they grow."""
    simulator, snapshots, _ = diverged(method)
    assert simulator.snapshot().time_ns == snapshots[-1].time_ns
    assert simulator.snapshot().state.tobytes() == snapshots[-1].state.tobytes()
    with np.errstate(over='raise', invalid='raise'):
        for snapshot in snapshots:
            assert np.isfinite(snapshot.state).all()
            assert np.isfinite(snapshot.net_forces).all()
            energy = snapshot.energy
            assert np.isfinite([energy.total, energy.imbalance, *energy.work.values()]).all()


def test_the_reason_names_body_time_and_remedy_in_one_line():
    simulator, snapshots, reason = diverged()
    assert "the motion of 'sphere' is no longer finite between " in reason
    assert f'the state of {snapshots[-1].time_ns * 1e-9:.9g} s is kept' in reason
    assert 'give a shorter step than 0.3 s' in reason
    assert '\n' not in reason
    assert simulator.failure == reason


def test_it_does_not_go_on_until_reset():
    simulator, snapshots, reason = diverged()
    for _ in range(2):
        with pytest.raises(DivergenceError) as caught:
            simulator.advance_tick()
        assert str(caught.value) == reason
    assert simulator.snapshot().state.tobytes() == snapshots[-1].state.tobytes()
    assert simulator.tick == len(snapshots) - 1
    simulator.reset()
    assert simulator.failure is None
    assert simulator.snapshot().state.tobytes() == snapshots[0].state.tobytes()
    simulator.apply(SetValues({'step': 0.001}))
    simulator.run(1.0)


def test_a_stiff_spring_says_so_too():
    scene = with_values(load_scene('two_anchors'), {'left_spring.stiffness': 1e12})
    with pytest.raises(DivergenceError, match='smaller stiffness, damping or drag'):
        Simulator(scene, integrator='rk4').run(1.0)
