# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Particles have no orientation, no angular velocity and no torque: not zeros, absent."""

from dataclasses import replace

from dynsim_ros.scene import (Air, load_scene, parse_scene, Particle, Scene, scene_quantities,
                              scene_to_yaml, SceneError)
from dynsim_ros.simulation import Simulator
from dynsim_ros.simulation.snapshot import WRENCH_KINDS
import pytest

ROTATING = ('orientation', 'angular', 'torque', 'rotational', 'inertia', 'radius', 'offset')


@pytest.fixture
def snapshot():
    return Simulator(load_scene('particle_on_spring')).snapshot()


def test_state_has_no_place_for_them(snapshot):
    assert snapshot.state.size == 3 + 3 + len(snapshot.energy.work)
    assert snapshot.layout.orientation('particle') is None
    assert snapshot.layout.angular_velocity('particle') is None


def test_snapshot_has_none(snapshot):
    assert snapshot.orientation('particle') is None
    assert snapshot.angular_velocity('particle') is None
    for kind in (*WRENCH_KINDS, 'net'):
        force, torque = snapshot.wrench(kind, 'particle')
        assert force.shape == (3,)
        assert torque is None


def test_no_quantity_and_no_line_of_its_scene_is_about_rotation():
    scene = Scene(bodies=(Particle(name='p', mass=1),),
                  air=Air(linear_drag=1, rotational_drag=1, angular_velocity=(1, 0, 0)))
    for given in (scene, load_scene('particle_on_spring')):
        assert not [name for name in scene_quantities(given)
                    if any(word in name for word in ROTATING)]
    text = scene_to_yaml(replace(load_scene('particle_on_spring'), description=''))
    assert not any(word in text for word in ROTATING)


@pytest.mark.parametrize('field', ['orientation: [0, 0, 0, 1]', 'angular_velocity: [0, 0, 1]',
                                   'inertia: 1', 'radius: 1'])
def test_a_scene_cannot_give_them(field):
    with pytest.raises(SceneError, match=f"p: there is no field '{field.split(':')[0]}'"):
        parse_scene('bodies: {p: {shape: particle, mass: 1, ' + field + '}}')


def test_a_spring_attaches_to_the_point_itself():
    with pytest.raises(SceneError, match="s.to_offset: 'p' is a point and has no attachment"):
        parse_scene("""
            anchors: {a: {position: [0, 0, 0]}}
            bodies: {p: {shape: particle, mass: 1}}
            springs: {s: {from: a, to: p, stiffness: 1, natural_length: 1, to_offset: [0, 0, 1]}}
            """)
