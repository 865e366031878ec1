# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The sheet's hint on L -> 0: an epsilon keeps the direction of the spring finite."""

from dynsim_ros.physics.model import build_model
from dynsim_ros.physics.spring_damper import length_and_direction
from dynsim_ros.scene import Anchor, parse_scene, Particle, Scene, Sphere, Spring
import numpy as np
from plain import compiled_and_plain, vectors
import pytest


def epsilon(natural_length, radius=None):
    body = Particle(name='b', mass=1)
    if radius is not None:
        body = Sphere(name='b', mass=1, radius=radius)
    spring = Spring(name='s', from_='a', to='b', stiffness=1, natural_length=natural_length)
    scene = Scene(bodies=(body,), anchors=(Anchor(name='a', position=(0, 0, 0)),),
                  springs=(spring,))
    return build_model(scene).springs[0].epsilon[0]


@compiled_and_plain(length_and_direction)
@pytest.mark.parametrize('natural_length', [0.0, 1e-320, 1e-300, 1e-9, 0.5, 1e6])
def test_at_length_zero_all_is_finite(formula, natural_length):
    length, u = formula((0.0, 0.0, 0.0), epsilon(natural_length))
    assert length == 0.0
    assert u == (0.0, 0.0, 0.0)


@compiled_and_plain(length_and_direction)
def test_through_zero_u_is_never_longer_than_one_but_for_its_last_bit(formula):
    e = epsilon(0.5)
    for exponent in range(-330, 10):
        _, u = formula((0.0, -float(f'1e{exponent}'), 0.0), e)
        assert np.isfinite(u).all() and -1.0 - 2.0 ** -52 <= u[1] <= 0.0


@compiled_and_plain(length_and_direction)
@pytest.mark.parametrize('natural_length, radius', [(0.5, None), (0.3, 0.1), (0.7, 2.0), (0, 3)])
def test_epsilon_changes_no_bit_at_lengths_above_a_millionth(formula, natural_length, radius):
    e = epsilon(natural_length, radius)
    longest = max(natural_length, radius or 0)
    for r, (share, _, _) in zip(vectors(500), vectors(501)):
        r = tuple(np.array(r) / np.linalg.norm(r) * longest * 10 ** (-5.9 + 3 * abs(share)))
        assert formula(r, e) == formula(r, 0.0)


def test_a_zero_length_spring_has_an_epsilon_too():
    assert 0.0 < epsilon(0.0) < 1e-15


def test_epsilon_grows_with_the_lengths_of_the_spring():
    assert epsilon(1e-6) == pytest.approx(1e-6 * epsilon(1.0), rel=1e-12)
    assert epsilon(0.1, radius=2.0) == epsilon(2.0)


def test_attached_offsets_count_as_lengths():
    scene = parse_scene("""
        bodies:
          a: {shape: sphere, mass: 1, radius: 0.1}
          b: {shape: box, mass: 1, size: [1, 1, 4], position: [9, 0, 0]}
        springs: {s: {from: a, to: b, stiffness: 1, natural_length: 0.5}}""")
    assert build_model(scene).springs[0].epsilon[0] == epsilon(2.0)
