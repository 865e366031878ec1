# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a snapshot says of forces, moments and energies."""

from dynsim_ros.scene import load_scene, scene_names
from dynsim_ros.simulation import Simulator
from dynsim_ros.simulation.snapshot import WRENCH_KINDS
from newton_euler import NewtonEuler, rotation_of
import numpy as np
import pytest


@pytest.mark.parametrize('name', scene_names())
def test_net_wrench_is_the_sum_and_agrees_with_newton_euler(name):
    scene = load_scene(name)
    simulator = Simulator(scene, integrator='rk4')
    simulator.run(0.2)
    now, reference = simulator.snapshot(), NewtonEuler(scene)
    motion = {body.name: [now.position(body.name), now.velocity(body.name)]
              + ([rotation_of(now.orientation(body.name)), now.angular_velocity(body.name)]
                 if now.orientation(body.name) is not None else []) for body in scene.bodies}
    loads = reference.loads(0.2, reference.unpacked(reference.packed(motion)))
    for body, (force, moment) in loads.items():
        parts = [now.wrench(kind, body) for kind in WRENCH_KINDS]
        net_force, net_torque = now.wrench('net', body)
        np.testing.assert_allclose(net_force, force, atol=1e-12)
        np.testing.assert_allclose(sum(part[0] for part in parts), net_force, atol=1e-13)
        if net_torque is not None:
            np.testing.assert_allclose(net_torque, moment, atol=1e-13)
            np.testing.assert_allclose(sum(part[1] for part in parts), net_torque, atol=1e-14)


@pytest.mark.parametrize('name', scene_names())
def test_accelerations_are_how_fast_velocities_change(name):
    scene, dt = load_scene(name), 1e-5
    simulator = Simulator(scene, integrator='rk4', step=dt / 2, rate=1e4)
    simulator.run(0.1)
    now = simulator.snapshot()
    later = simulator.copy()
    later.advance(round(dt * 1e9))
    rate = (later.snapshot().state - now.state) / dt
    for body in scene.bodies:
        for place in (now.layout.velocity(body.name), now.layout.angular_velocity(body.name)):
            if place is not None:
                np.testing.assert_allclose(now.accelerations[place], rate[place], atol=0.05,
                                           rtol=1e-3)


def test_energies_of_a_known_state():
    """The sphere scene at its start, by hand."""
    scene = load_scene('sphere_on_spring')
    energy, body = Simulator(scene).snapshot().energy, scene.bodies[0]
    edge = np.array(body.position) + rotation_of(body.orientation).apply([0, 0, 0.1])
    assert energy.kinetic == pytest.approx(0.5 * 0.5 ** 2 + 0.5 * 0.4 * 0.1 ** 2 * 14, rel=1e-14)
    assert energy.gravitational == pytest.approx(9.81 * 1.2, rel=1e-14)
    assert energy.spring == pytest.approx(50 * (np.linalg.norm(edge - (0, 0, 2)) - 0.5) ** 2)
    assert energy.total == energy.kinetic + energy.gravitational + energy.spring
    assert energy.imbalance == 0.0
    assert energy.work == {'damper': 0.0, 'air': 0.0, 'anchor': 0.0, 'push': 0.0}


def test_numbers_of_tick_epoch_and_time():
    simulator = Simulator(load_scene('falling_in_wind'), rate=50)
    simulator.run(0.1)
    snapshot = simulator.snapshot()
    assert (snapshot.tick, snapshot.epoch, snapshot.time_ns) == (5, 0, 100_000_000)
    simulator.reset()
    snapshot = simulator.snapshot()
    assert (snapshot.tick, snapshot.epoch, snapshot.time_ns) == (0, 1, 0)


def test_prepare_changes_nothing():
    simulator = Simulator(load_scene('sphere_on_spring'))
    before = simulator.snapshot()
    simulator.prepare()
    assert simulator.snapshot().state.tobytes() == before.state.tobytes()
    assert simulator.time_ns == 0
