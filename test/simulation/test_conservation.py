# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Momentum, angular momentum and energy of bodies that only pull at each other."""

from dynsim_ros.scene import parse_scene, with_values
from dynsim_ros.simulation import Simulator
from newton_euler import inertia_matrix, NewtonEuler, rotation_of
import numpy as np
import pytest

SCENE = parse_scene("""
bodies:
  dot: {shape: particle, mass: 0.7, position: [0, 0.5, 0.2], velocity: [0.2, 0.1, -0.3]}
  ball: {shape: sphere, mass: 1.3, radius: 0.2, position: [1, 0, 0], angular_velocity: [1, 2, 0]}
  crate: {shape: box, mass: 2, size: [0.3, 0.5, 0.9], position: [0, 0, 1],
          velocity: [0, 0.5, 0], angular_velocity: [0, 1, 3]}
springs:
  ball_crate: {from: ball, to: crate, to_offset: [0.15, 0, -0.45], stiffness: 40,
               natural_length: 0.6, damping: 0}
  dot_ball: {from: dot, to: ball, stiffness: 30, natural_length: 0.3,
             damping: 0}
  crate_dot: {from: crate, from_offset: [0, 0.25, 0], to: dot, stiffness: 20,
              natural_length: 0.5, damping: 0}
""")
DAMPED = with_values(SCENE, {f'{spring.name}.damping': 0.8 for spring in SCENE.springs})


def momenta(snapshot):
    """Return momentum and angular momentum about the origin of world."""
    linear, angular = np.zeros(3), np.zeros(3)
    for body in SCENE.bodies:
        momentum = body.mass * snapshot.velocity(body.name)
        linear += momentum
        angular += np.cross(snapshot.position(body.name), momentum)
        if snapshot.orientation(body.name) is not None:
            turn = rotation_of(snapshot.orientation(body.name))
            omega = turn.inv().apply(snapshot.angular_velocity(body.name))
            angular += turn.apply(inertia_matrix(body) @ omega)
    return np.array([linear, angular])


@pytest.fixture(scope='module', params=[SCENE, DAMPED], ids=['undamped', 'damped'])
def run(request):
    return Simulator(request.param, integrator='rk4', step=2e-4, rate=20).run(2.0)


def test_momentum_and_angular_momentum_are_conserved(run):
    found = np.array([momenta(snapshot) for snapshot in run.snapshots])
    # momentum but for rounding; angular momentum but for the method's error
    np.testing.assert_allclose(found[:, 0], np.tile(found[0, 0], (41, 1)), atol=1e-13)
    np.testing.assert_allclose(found[:, 1], np.tile(found[0, 1], (41, 1)), atol=2e-11)


def test_forces_and_moments_of_all_springs_add_up_to_nothing(run):
    for kind in ('spring', 'damper'):
        for snapshot in run.snapshots:
            wrenches = {body.name: snapshot.wrench(kind, body.name) for body in SCENE.bodies}
            total = sum(force for force, _ in wrenches.values())
            moment = sum(np.cross(snapshot.position(name), force)
                         + (0 if torque is None else torque)
                         for name, (force, torque) in wrenches.items())
            np.testing.assert_allclose(total, 0, atol=1e-14)
            np.testing.assert_allclose(moment, 0, atol=1e-13)


def test_energy_is_conserved_without_dampers_and_falls_with_them(run):
    energy = run.energy()
    if run.snapshots[-1].energy.work['damper'] == 0.0:
        np.testing.assert_allclose(energy, energy[0], rtol=1e-11)
    else:
        assert (np.diff(energy) < 0).all()
        assert energy[-1] < 0.6 * energy[0]


@pytest.mark.parametrize('scene', [SCENE, DAMPED], ids=['undamped', 'damped'])
def test_motion_agrees_with_newton_euler(scene):
    simulator = Simulator(scene, integrator='rk4', step=1e-4)
    simulator.advance(1_000_000_000)
    end = simulator.snapshot()
    for name, (r, v, matrix, omega) in NewtonEuler(scene).solve([1.0])[0].items():
        np.testing.assert_allclose(end.position(name), r, atol=1e-10)
        np.testing.assert_allclose(end.velocity(name), v, atol=1e-10)
        if matrix is not None:
            np.testing.assert_allclose(end.angular_velocity(name), omega, atol=1e-9)
            np.testing.assert_allclose(rotation_of(end.orientation(name)).as_matrix(), matrix,
                                       atol=1e-10)
