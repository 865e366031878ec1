# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Forces, moments, accelerations, rates and powers of a scene with everything in it.

Springs between every two kinds of ends with and without damper and offset, every kind of body,
air, gravity along an odd direction, moving anchors and pushes, at random states, against
newton_euler.py, which solves Euler's equation in world axes with numpy.
"""

from pathlib import Path

from plain import in_plain_python
import pytest

BODIES = {'dot': False, 'dust': False, 'potato': True, 'ball': True, 'crate': True, 'die': True,
          'top': True}


@pytest.fixture(scope='module')
def differences():
    found = in_plain_python(Path(__file__).with_name('every_kind.py'))
    assert found['springs'] == 54
    return found['worst']


@pytest.mark.parametrize('body', BODIES)
def test_forces_and_moments(differences, body):
    assert differences[f'{body} force'] < 1e-14
    assert not BODIES[body] or differences[f'{body} moment'] < 1e-14


@pytest.mark.parametrize('body', BODIES)
def test_accelerations(differences, body):
    assert differences[f'{body} velocity'] < 1e-14
    assert not BODIES[body] or differences[f'{body} omega'] < 1e-14


@pytest.mark.parametrize('body', BODIES)
def test_rates_of_position_and_orientation(differences, body):
    assert differences[f'{body} position'] == 0.0
    # against a finite difference
    assert not BODIES[body] or differences[f'{body} quaternion rate'] < 1e-9


@pytest.mark.parametrize('body', [name for name, rigid in BODIES.items() if not rigid])
def test_nothing_rotates_of_a_particle(differences, body):
    assert {name for name in differences if name.startswith(body)} == {
        f'{body} position', f'{body} velocity', f'{body} force'}


def test_the_powers_counted_are_the_rate_of_the_energy(differences):
    # against a finite difference
    assert differences['power work'] < 2e-6
