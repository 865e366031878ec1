# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A state that advances while its rates are written, against rates that are written first."""

from fractions import Fraction

from dynsim_ros.physics.advancing import Advancing
from dynsim_ros.physics.drive import undisturbed_drive
from dynsim_ros.physics.model import build_model
from dynsim_ros.physics.motion import put_rates, rates
from dynsim_ros.physics.state import initial_state
from dynsim_ros.scene import parse_scene
import numba
import numpy as np
import pytest

SCENE = parse_scene("""
gravity: 9.81
air: {linear_drag: 0.3, rotational_drag: 0.02, velocity: [1, 2, -1]}
anchors: {hand: {position: [0, 0, 2], velocity: [0.1, 0, 0.2]}}
bodies:
  ball: {shape: sphere, mass: 1.3, radius: 0.2, position: [0.3, 0, 1.2], velocity: [0, 0.5, 0],
         orientation: {axis: [1, 0, 0], angle: 0.3}, angular_velocity: [1, 2, 3]}
  crate: {shape: box, mass: 2, size: [0.3, 0.5, 0.9], angular_velocity: [3, 1, -2]}
  dot: {shape: particle, mass: 0.7, position: [0, 1, 0], velocity: [1, 0, 0]}
springs:
  first: {from: hand, to: ball, stiffness: 100, damping: 0.5, natural_length: 0.5}
  second: {from: ball, to: crate, stiffness: 50, damping: 0.1, natural_length: 0.2}
  third: {from: crate, to: dot, stiffness: 20, natural_length: 0.3}
""")
STEP, TIME = 0.013, 0.37


@pytest.fixture(scope='module')
def model():
    return build_model(SCENE)


@pytest.fixture(scope='module')
def start(model):
    return initial_state(SCENE, model)


def advanced(call, model, start):
    """Return change and state behind a step by call(put_rates), and the change before it."""
    before = 1e-3 * np.random.default_rng(3).normal(size=len(start))
    change, whole, forces = before.copy(), np.zeros(len(start)), np.zeros(len(start))
    call(model, undisturbed_drive(SCENE, works=True), TIME, start, forces,
         Advancing(STEP, change, start, whole))
    return change, whole, before


@numba.njit(error_model='numpy')
def compiled(model, drive, t, y, forces, out):
    put_rates(model, drive, t, y, forces, out)


@pytest.mark.parametrize('call', [put_rates, compiled], ids=['plain', 'compiled'])
def test_it_goes_on_by_the_rates(call, model, start):
    change, whole, before = advanced(call, model, start)
    rate = np.zeros(len(start))
    rates(model, undisturbed_drive(SCENE, works=True), TIME, start, rate)
    exact = [float(Fraction(b) + Fraction(STEP) * Fraction(r)) for b, r in zip(before, rate)]
    # masses are divided by together with the step: another rounding
    assert np.abs(change - exact).max() < 1e-15 * np.abs(STEP * rate).max()
    assert whole.tolist() == (start + change).tolist()


def test_the_same_bits_compiled_and_plain(model, start):
    for found, expected in zip(advanced(compiled, model, start),
                               advanced(put_rates, model, start)):
        assert found.tolist() == expected.tolist()
