# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a scene lacks, or has as zero, is None in its model."""

from dataclasses import replace

from dynsim_ros.physics.model import build_model
from dynsim_ros.physics.state import state_size
from dynsim_ros.scene import Air, load_scene, Particle, Scene, Sphere
from dynsim_ros.simulation import Simulator
import pytest

BARE = Scene(bodies=(Particle(name='p', mass=1),))


def test_a_bare_particle_has_a_mass_and_nothing_else():
    model = build_model(BARE)
    assert model.mass.tolist() == model.inverse_mass.tolist() == [1.0]
    assert model.rigid == 0
    assert all(part is None for part in model[3:])


def test_gravity():
    assert build_model(replace(BARE, gravity=0.0)).weight is None
    assert build_model(load_scene('spinning_box')).weight is None


def test_springs_and_dampers():
    groups = build_model(load_scene('particle_on_spring')).springs
    assert [group.damping for group in groups] == [None]
    assert build_model(load_scene('sphere_on_spring')).springs[0].damping is not None
    assert build_model(load_scene('falling_in_wind')).springs is None


def test_springs_that_pull_at_nothing():
    scene = load_scene('two_anchors')
    first, second = scene.springs

    def springs(*springs):
        model = build_model(replace(scene, springs=springs))
        groups = model.springs or ()
        return [group.stiffness.tolist() for group in groups], model.connections

    def loose(spring):
        return replace(spring, stiffness=0.0, damping=0.0)

    assert springs(loose(first), loose(second)) == ([], None)
    assert springs(loose(first), second) == ([[second.stiffness]], None)
    assert springs(first, loose(second)) == ([[first.stiffness]], None)
    # a damper without a spring is something
    assert springs(replace(first, stiffness=0.0, damping=1.0))[0] == [[0.0]]


def test_a_damper_of_zero_is_none():
    scene = load_scene('sphere_on_spring')
    undamped = replace(scene, springs=(replace(scene.springs[0], damping=0.0),))
    assert [group.damping for group in build_model(undamped).springs] == [None]


def test_ends_of_springs():
    p, q = build_model(load_scene('particle_on_spring')).springs[0][:2]
    assert [end is None for end in p] == [False, True, True, True]
    assert [end is None for end in q] == [True, False, True, True]
    q = build_model(load_scene('sphere_on_spring')).springs[0].q
    assert [end is None for end in q] == [True, True, False, False]


@pytest.mark.parametrize('air, drags', [
    (None, None), (Air(), None), (Air(velocity=(1, 0, 0)), None),
    (Air(linear_drag=1), (1.0, None)), (Air(rotational_drag=2), (None, 2.0)),
    (Air(linear_drag=0, rotational_drag=2), (None, 2.0)),
    (Air(linear_drag=0, rotational_drag=0, velocity=(1, 0, 0)), None)])
def test_air(air, drags):
    model = build_model(Scene(bodies=(Sphere(name='s', mass=1, radius=1),), air=air))
    assert (model.air and model.air[:2]) == drags


def test_air_that_only_resists_rotation_is_absent_for_particles():
    assert build_model(replace(BARE, air=Air(rotational_drag=2))).air is None


@pytest.mark.parametrize('scene', ['sphere_on_spring', 'spinning_box'])
def test_only_one_kind_of_inertia(scene):
    model = build_model(load_scene(scene))
    full = scene == 'spinning_box'
    assert (model.round_inertia is None) is full
    assert (model.inertia is None) is (model.inverse_inertia is None) is not full


def test_the_state_of_a_particle_is_position_and_velocity():
    # and four works, which belong to the run
    assert state_size(1, 0) - state_size(0, 0) == 6
    assert state_size(1, 1) - state_size(0, 0) == 13
    assert Simulator(load_scene('particle_on_spring')).snapshot().state.size == 6 + 4
