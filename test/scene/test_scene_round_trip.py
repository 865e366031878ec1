# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A scene written as YAML and read again is the same scene, to the last bit."""

import math

from dynsim_ros.scene import (Air, Anchor, Box, load_scene, parse_scene, Particle, read_scene,
                              RigidBody, Scene, scene_names, scene_to_yaml, Sphere, Spring)
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
import yaml


def test_scenes_of_the_package():
    assert scene_names() == ['double_pendulum_of_spheres', 'falling_in_wind',
                             'particle_on_spring', 'sphere_on_spring', 'spinning_box',
                             'two_anchors']


@pytest.mark.parametrize('name', scene_names())
def test_a_scene_of_the_package(name):
    scene = load_scene(name)
    assert scene.name == name
    assert scene.description.endswith('.')
    assert parse_scene(scene_to_yaml(scene)) == scene


def random_scene(random):
    """Return a scene with everything in it and numbers that have all their digits."""
    def vector():
        return tuple(random.normal(size=3))

    def motion(name, rigid=True):
        more = {'orientation': tuple(Rotation.random(None, random).as_quat()),
                'angular_velocity': vector()} if rigid else {}
        return {'name': name, 'mass': random.uniform(), 'position': vector(),
                'velocity': vector(), **more}

    turned = Rotation.random(None, random).as_matrix()
    inertia = turned @ np.diag([2.0, 3.0, 4.0]) @ turned.T
    inertia = (inertia + inertia.T) / 2
    return Scene(
        name='1e6', description='quotes " and \' and: colons\nand lines',
        gravity=random.uniform(), down=vector(),
        air=Air(linear_drag=random.uniform(), velocity=vector(), angular_velocity=vector()),
        anchors=(Anchor(name='no', position=vector(), velocity=vector()),),
        bodies=(Particle(**motion('p', rigid=False)), Sphere(radius=0.1, **motion('s')),
                Box(size=tuple(random.uniform(0.1, 1, 3)), **motion('on')),
                RigidBody(inertia=0.3, **motion('r1')),
                RigidBody(inertia=(2, 3, 4), **motion('r2')),
                RigidBody(inertia=tuple(map(tuple, inertia.tolist())), **motion('r3'))),
        springs=(Spring(name='k', from_='no', to='s', stiffness=random.uniform(),
                        natural_length=random.uniform(), damping=random.uniform(),
                        to_offset=vector()),
                 Spring(name='l', from_='on', to='p', stiffness=1, natural_length=0)))


def test_random_scenes():
    random = np.random.default_rng(3)
    for _ in range(60):
        scene = random_scene(random)
        again = parse_scene(scene_to_yaml(scene))
        assert again == scene
        assert scene_to_yaml(again) == scene_to_yaml(scene)


def test_what_is_written_is_plain_yaml():
    data = yaml.safe_load(scene_to_yaml(random_scene(np.random.default_rng(4))))
    assert list(data) == ['name', 'description', 'gravity', 'down', 'air', 'anchors', 'bodies',
                          'springs']
    assert data['springs']['k']['from'] == 'no'
    assert 'damping' not in data['springs']['l']


def test_a_quaternion_is_written_in_the_order_of_ros():
    q = (math.cos(0.2), math.sin(0.2), 0.0, 0.0)
    scene = Scene(bodies=(Sphere(name='s', mass=1, radius=1, orientation=q),))
    written = yaml.safe_load(scene_to_yaml(scene))['bodies']['s']['orientation']
    assert written == [q[1], q[2], q[3], q[0]]


def test_from_a_file(tmp_path):
    path = tmp_path / 'my_scene.yaml'
    path.write_text('bodies: {p: {shape: particle, mass: 1}}', encoding='utf-8')
    assert read_scene(path).name == 'my_scene'
    assert load_scene(str(path)) == load_scene(path) == read_scene(path)
