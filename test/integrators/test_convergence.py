# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Measured order of convergence of each method of fixed step, in position and in orientation.

The slope of log(error) over log(step), error against DOP853 (rtol 1e-13) on newton_euler.py.
"""

import functools

from dynsim_ros.integrators import METHODS
from dynsim_ros.scene import load_scene, with_values
from dynsim_ros.simulation import Simulator
from newton_euler import NewtonEuler, rotation_distance
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

FIXED = [name for name, method in METHODS.items() if method.advance is not None]
# Few steps for the method of order 4: with many, rounding is all that is left.
STEPS = {'rk4': (4e-3, 2e-3, 1e-3)}
SMALL_STEPS = (2e-4, 1e-4, 5e-5)


@functools.cache
def scenes():
    return {'sphere on a moving hand': with_values(load_scene('sphere_on_spring'), {
                'hand.velocity': (0.3, 0.2, 0.1), 'air.angular_velocity': (0.5, 0, 1)}),
            'box without forces': with_values(load_scene('spinning_box'), {
                'box.velocity': (1, 2, 3), 'box.angular_velocity': (3, 6, -2)})}


@functools.cache
def exact(name, duration=0.4):
    return NewtonEuler(scenes()[name]).solve([duration])[0]


def errors(name, method, step, duration=0.4):
    """Return errors of (position, velocity, orientation, angular velocity) at the end."""
    scene = scenes()[name]
    body = scene.bodies[0].name
    simulator = Simulator(scene, step=step, integrator=method)
    simulator.advance(round(duration * 1e9))
    end, (r, v, matrix, omega) = simulator.snapshot(), exact(name)[body]
    return (np.linalg.norm(end.position(body) - r), np.linalg.norm(end.velocity(body) - v),
            rotation_distance(end.orientation(body), Rotation.from_matrix(matrix)),
            np.linalg.norm(end.angular_velocity(body) - omega))


def slopes(name, method, first=0):
    """Return the orders, one row per halving of the step, beginning at column `first`."""
    steps = STEPS.get(method, SMALL_STEPS)
    found = np.array([errors(name, method, step)[first:] for step in steps])
    return np.log(found[:-1] / found[1:]) / np.log(2.0)


@pytest.mark.parametrize('method', FIXED)
def test_order_of_a_body_with_all_forces(method):
    orders = slopes('sphere on a moving hand', method)
    np.testing.assert_allclose(orders, METHODS[method].order, atol=0.15)


@pytest.mark.parametrize('method', FIXED)
def test_order_of_eulers_full_equation(method):
    orders = slopes('box without forces', method, first=2)
    np.testing.assert_allclose(orders, METHODS[method].order, atol=0.15)


@pytest.mark.parametrize('method', FIXED)
def test_motion_without_forces_is_exact_in_position(method):
    # but for one rounding in each of the 400 steps
    assert errors('box without forces', method, 1e-3)[0] < 400 * 2.0 ** -52


def test_the_orders_are_those_of_the_theory():
    assert {name: METHODS[name].order for name in FIXED} == {
        'rk4': 4, 'leapfrog': 2, 'semi_implicit_euler': 1, 'linearly_implicit_euler': 1,
        'explicit_euler': 1, 'explicit_euler_axis_angle': 1}
