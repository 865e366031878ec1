# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is taken for a number in a scene, and what is not."""

import math

from dynsim_ros.scene import parse_scene, Particle, RigidBody, SceneError, Sphere
import numpy as np
import pytest
from scipy.spatial.transform import Rotation


def mass(text):
    return parse_scene('bodies: {p: {shape: particle, mass: ' + text + '}}').bodies[0].mass


@pytest.mark.parametrize('text, value', [
    ('1', 1.0), ('1.5', 1.5), ('1e3', 1000.0), ('1E3', 1000.0), ('1e-3', 0.001), ('1.5e+3', 1500),
    ('+2', 2.0), ('.5', 0.5), ('5.', 5.0), ('1_000', 1000.0), ('"1e3"', 1000.0), ('0x10', 16.0)])
def test_numbers(text, value):
    assert mass(text) == value
    assert type(mass(text)) is float


@pytest.mark.parametrize('text', ['true', 'no', 'heavy', '"1 kg"', '"1,5"', '1e', 'e3', '""', '[]',
                                  '[1]', '{a: 1}', '2001-01-01', '!!set {1, 2}', '"0x10"'])
def test_no_numbers(text):
    with pytest.raises(SceneError, match=r'^p\.mass: .* is not a number; give a number in kg$'):
        mass(text)


@pytest.mark.parametrize('text', ['.nan', '.NaN', '.inf', '-.inf', '1e999', '"-1e999"',
                                  '0x' + 'f' * 400])
def test_not_finite(text):
    with pytest.raises(SceneError, match=r'^p\.mass: -?(nan|inf) is not finite; give a number'):
        mass(text)


@pytest.mark.parametrize('value', [np.float64(2), np.float32(2), np.int32(2), np.array(2.0), 2])
def test_numbers_of_numpy_become_floats(value):
    assert Particle(name='p', mass=value).mass == 2.0
    assert type(Particle(name='p', mass=value).mass) is float
    assert Particle(name='p', mass=1, position=np.array([1, 2, 3])).position == (1.0, 2.0, 3.0)


@pytest.mark.parametrize('position', ['5', '[1, 2]', '[1, 2, 3, 4]', '{x: 1, y: 2, z: 3}', 'abc',
                                      '!!set {1, 2, 3}', '!!binary YWJj'])
def test_no_vectors(position):
    with pytest.raises(SceneError, match=r'^p\.position: .* is not a list of 3 numbers in m$'):
        parse_scene('bodies: {p: {shape: particle, mass: 1, position: ' + position + '}}')


@pytest.mark.parametrize('orientation, words', [
    ((1, 1, 0, 0), r'norm is 1.41421, a unit quaternion is needed'),
    ((0, 0, 0, 0), 'norm is 0, a unit'), ((1, 0, 0), 'is not a list of 4 numbers'),
    ((2, 0, 0, 0), 'out of range: -1.1 to 1.1'), ((float('nan'), 0, 0, 1), 'not finite')])
def test_no_orientations(orientation, words):
    with pytest.raises(SceneError, match=words):
        Sphere(name='s', mass=1, radius=1, orientation=orientation)


def test_an_orientation_that_is_nearly_of_norm_1_is_made_so():
    q = Sphere(name='s', mass=1, radius=1, orientation=(0.7071, 0.7071, 0, 0)).orientation
    assert math.hypot(*q) == pytest.approx(1, abs=3e-16)


@pytest.mark.parametrize('inertia, words', [
    (0, r'0 kg m\^2 is out of range: 1e-15 to'), ((1, 2), 'give one number, three principal'),
    ((1, 1, 3), 'principal moments 1, 1, 3 kg m.2 belong to no body'),
    (((1, 0.1, 0), (0, 1, 0), (0, 0, 1)), 'is not symmetric'),
    (((1, 2, 0), (2, 1, 0), (0, 0, 1)), 'principal moments -1, 1, 3 kg'),
    (((1, 0), (0, 1), (0, 0)), r'\[0\]: .* is not a list of 3 numbers'),
    ((1, (2, 3, 4), 5), r'\[1\]: .* is not a number'),
    ({1, 2, 3}, 'is not a number'), ('heavy', "'heavy' is not a number")])
def test_no_inertias(inertia, words):
    with pytest.raises(SceneError, match=f'^b.inertia.*{words}'):
        RigidBody(name='b', mass=1, inertia=inertia)


def test_a_thin_rod_however_turned_has_no_inertia_to_divide_by():
    """Its matrix, of rank 2 but for rounding, cannot be inverted."""
    for seed in range(50):
        turn = Rotation.random(random_state=seed).as_matrix()
        matrix = turn @ np.diag([0.0, 1.0, 1.0]) @ turn.T
        with pytest.raises(SceneError, match='belong to no body'):
            RigidBody(name='rod', mass=1, inertia=((matrix + matrix.T) / 2).tolist())
