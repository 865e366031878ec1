# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What rests for ever is held, and what would leave its place, by and by, is not."""

from integrators.closed_scene.recognised import recognised
import pytest
from scipy.optimize import brentq


def hanging(height, body='shape: particle', stiffness=100.0, anchor=(0, 0, 2), more=''):
    return f"""
gravity: 9.81
anchors: {{hand: {{position: {list(anchor)}}}}}
bodies: {{body: {{{body}, mass: 1, position: [0, 0, {height!r}]{more}}}}}
springs: {{spring: {{from: hand, to: body, stiffness: {stiffness!r}, natural_length: 0.5}}}}"""


def place(stiffness, reach=0.0, anchor=2.0):
    """Return where a body of 1 kg hangs, as well as that can be told."""
    return brentq(lambda z: stiffness * (anchor - z - reach - 0.5) - 9.81, anchor - 20, anchor,
                  xtol=1e-300, rtol=1e-15)


SPHERE, BOX = 'shape: sphere, radius: 0.1', 'shape: box, size: [0.1, 0.2, 0.3]'


@pytest.mark.parametrize('stiffness', [3.7, 100.0, 12345.6, 1e9])
@pytest.mark.parametrize('body, reach', [('shape: particle', 0.0), (SPHERE, 0.1), (BOX, 0.15)])
def test_what_hangs_still_is_held(body, reach, stiffness):
    text = hanging(place(stiffness, reach), body, stiffness)
    assert recognised(text) == set()


def test_what_is_a_little_off_or_moves_is_not():
    height = place(100.0, 0.1)
    kinds = {'line', 'spins'}
    assert recognised(hanging(height + 1e-13, SPHERE)) == kinds
    assert recognised(hanging(height, SPHERE, more=', velocity: [0, 0, 1e-300]')) == kinds
    assert recognised(hanging(height, SPHERE, more=', velocity: [1e-300, 0, 0]')) is None
    assert recognised(hanging(height, SPHERE, more=', angular_velocity: [1e-300, 0, 0]')) is None
    assert recognised(hanging(height, SPHERE), force=(1e-9, 0, 0)) is None


def test_what_stands_on_a_spring_is_held_only_without_rounding():
    """On a spring from below: it would fall over, from a rounding on."""
    standing = brentq(lambda z: 100.0 * (0.5 - z) - 9.81, 0.1, 0.5, xtol=1e-300, rtol=1e-15)
    assert 100.0 * (standing - 0.5) + 9.81 != 0.0
    assert recognised(hanging(standing, anchor=(0, 0, 0))) == {'line'}
    assert recognised(hanging(0.25, anchor=(0, 0, 0)).replace('9.81', '25.0')) == set()


def two_springs(distance, natural_length, position=(0, 0, 0)):
    return f"""
anchors: {{left: {{position: [-{distance}, 0, 0]}}, right: {{position: [{distance}, 0, 0]}}}}
bodies: {{dot: {{shape: particle, mass: 1, position: {list(position)}}}}}
springs:
  a: {{from: left, to: dot, stiffness: 10, natural_length: {natural_length}}}
  b: {{from: dot, to: right, stiffness: 10, natural_length: {natural_length}}}"""


def test_between_springs_that_pull_or_push():
    assert recognised(two_springs(1, 0.7)) == set()
    assert recognised(two_springs(1, 1.3)) == set()
    # a rounding along the springs, which hold it there; across they pull it back, or push it out
    assert recognised(two_springs(1, 0.7, (1e-17, 0, 0))) == set()
    assert recognised(two_springs(1, 1.3, (1e-17, 0, 0))) == set()
    assert recognised(two_springs(1.1, 0.7, (1.3e-16, 0, 0))) == set()
    assert recognised(two_springs(1.1, 1.3, (1.3e-16, 0, 0))) is None


def test_moving_anchor_and_whirl_are_no_rest():
    text = hanging(place(100.0, 0.1), SPHERE)
    assert recognised(text.replace('[0, 0, 2]', '[0, 0, 2], velocity: [0, 0.1, 0]')) is None
    air = '\nair: {rotational_drag: 0.1, angular_velocity: [0, 1, 0]}'
    assert recognised(text + air) is None
    assert recognised(text + '\nair: {linear_drag: 0.1, rotational_drag: 0.1}') == set()


def test_several_bodies_hang_one_below_the_other():
    lower = brentq(lambda length: 50.0 * (length - 0.3) - 0.2 * 9.81, 0.0, 1.0, rtol=1e-15)
    upper = brentq(lambda length: 80.0 * (length - 0.3) - 0.5 * 9.81, 0.0, 1.0, rtol=1e-15)
    text = f"""
gravity: 9.81
anchors: {{hand: {{position: [0.3, 0.1, 2]}}}}
bodies:
  first: {{shape: particle, mass: 0.3, position: [0.3, 0.1, {2 - upper!r}]}}
  second: {{shape: sphere, mass: 0.2, radius: 0.1, position: [0.3, 0.1, {1.9 - upper - lower!r}]}}
springs:
  upper: {{from: hand, to: first, stiffness: 80, damping: 0.4, natural_length: 0.3}}
  lower: {{from: first, to: second, stiffness: 50, damping: 0.3, natural_length: 0.3}}"""
    assert recognised(text) == set()
    assert recognised(text.replace('[0.3, 0.1, 2]', '[0.3, 0.1, 2.0001]')) is None
