# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
What each method does to a harmonic oscillator, step by step, as its theory has it.

A sphere, held at its centre by a spring of natural length 0, without gravity, damper and air:
z'' = -omega^2 z. Each method multiplies (z, z' / omega) by a known matrix.
"""

from dynsim_ros.scene import load_scene, parse_scene, scene_to_yaml, with_values
from dynsim_ros.simulation import Simulator
import numpy as np
import pytest

OMEGA, STEP, STEPS = 10.0, 1e-3, 1000
X = OMEGA * STEP
EXPLICIT = np.array([[1, X], [-X, 1]])
SEMI_IMPLICIT = np.array([[1 - X * X, X], [-X, 1]])
GENERATOR = np.array([[0, X], [-X, 0]])
RK4 = sum(np.linalg.matrix_power(GENERATOR, n) / f for n, f in enumerate((1, 1, 2, 6, 24)))
MATRICES = {'explicit_euler': EXPLICIT, 'explicit_euler_axis_angle': EXPLICIT,
            'semi_implicit_euler': SEMI_IMPLICIT, 'rk4': RK4}


def oscillator():
    """Return the scene, of the same kind as sphere_on_spring: nothing more is compiled."""
    text = scene_to_yaml(load_scene('sphere_on_spring'))
    text = text.replace('to: sphere', 'to: sphere, to_offset: [0, 0, 0]')
    return with_values(parse_scene(text), {
        'gravity': 0, 'air.linear_drag': 0, 'air.rotational_drag': 0, 'spring.damping': 0,
        'spring.natural_length': 0, 'spring.stiffness': OMEGA ** 2, 'sphere.mass': 1,
        'hand.position': (0, 0, 0), 'sphere.position': (0, 0, 0.3),
        'sphere.velocity': (0, 0, 2), 'sphere.angular_velocity': (0, 0, 0)})


def run(method, steps):
    simulator = Simulator(oscillator(), step=STEP, integrator=method)
    simulator.advance(steps * 1_000_000)
    return simulator.snapshot()


@pytest.mark.parametrize('method', MATRICES)
def test_every_step_is_the_matrix_of_the_method(method):
    expected = np.linalg.matrix_power(MATRICES[method], STEPS) @ (0.3, 2 / OMEGA)
    end = run(method, STEPS)
    found = end.position('sphere')[2], end.velocity('sphere')[2] / OMEGA
    np.testing.assert_allclose(found, expected, atol=1e-13)
    np.testing.assert_array_equal(end.position('sphere')[:2], 0.0)


@pytest.mark.parametrize('method', ['explicit_euler', 'explicit_euler_axis_angle'])
def test_energy_of_explicit_euler_grows_by_one_plus_omega_h_squared_a_step(method):
    energy = [run(method, steps).energy.total for steps in (0, STEPS)]
    assert energy[1] / energy[0] == pytest.approx((1 + X ** 2) ** STEPS, rel=1e-12)


def test_energy_of_semi_implicit_euler_stays_bounded():
    energies = np.array([run('semi_implicit_euler', steps).energy.total
                         for steps in range(0, 100_000, 1777)])
    assert np.abs(energies / energies[0] - 1).max() < X


def test_energy_of_rk4_decays_by_its_sixth_order_term():
    energy = [run('rk4', steps).energy.total for steps in (0, STEPS)]
    damping = (1 - X ** 6 / 72 + X ** 8 / 576) ** STEPS
    assert energy[1] / energy[0] - 1 == pytest.approx(damping - 1, abs=1e-13)
