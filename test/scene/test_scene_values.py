# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The quantities of a scene by name: the same names as ROS parameters and --set have."""

from dynsim_ros.scene import (get_value, load_scene, parse_scene, scene_names, scene_quantities,
                              SceneError, with_values)
import numpy as np
import pytest

SCENE = load_scene('sphere_on_spring')


def test_names_of_the_default_scene():
    assert sorted(scene_quantities(SCENE)) == [
        'air.angular_velocity', 'air.linear_drag', 'air.rotational_drag', 'air.velocity', 'down',
        'gravity', 'hand.position', 'hand.velocity', 'sphere.angular_velocity', 'sphere.mass',
        'sphere.orientation', 'sphere.position', 'sphere.radius', 'sphere.velocity',
        'spring.damping', 'spring.natural_length', 'spring.stiffness']


def test_what_a_scene_lacks_has_no_name():
    assert sorted(scene_quantities(load_scene('spinning_box'))) == [
        'box.angular_velocity', 'box.mass', 'box.orientation', 'box.position', 'box.size',
        'box.velocity']
    names = scene_quantities(load_scene('particle_on_spring'))
    assert 'spring.damping' not in names
    assert not [name for name in names if name.startswith('air')]


@pytest.mark.parametrize('name', scene_names())
def test_every_quantity_has_unit_meaning_and_bounds_and_can_be_set_to_what_it_is(name):
    scene = load_scene(name)
    for quantity_name, quantity in scene_quantities(scene).items():
        assert quantity.description
        assert quantity.unit or quantity.kind in ('direction', 'orientation')
        assert quantity.minimum < quantity.maximum
        value = get_value(scene, quantity_name)
        assert with_values(scene, {quantity_name: value}) == scene


def test_a_group_of_values():
    changed = with_values(SCENE, {'gravity': 1, 'sphere.mass': '2e0', 'hand.position': [1, 2, 3],
                                  'air.velocity': np.array([4, 5, 6]), 'spring.damping': 7})
    assert (changed.gravity, changed.bodies[0].mass, changed.anchors[0].position,
            changed.air.velocity, changed.springs[0].damping) == (
                1.0, 2.0, (1.0, 2.0, 3.0), (4.0, 5.0, 6.0), 7.0)
    assert load_scene('sphere_on_spring') == SCENE


def test_orientation_is_x_y_z_w():
    changed = with_values(SCENE, {'sphere.orientation': [0.6, 0, 0, 0.8]})
    assert changed.bodies[0].orientation == (0.8, 0.6, 0.0, 0.0)
    assert get_value(changed, 'sphere.orientation') == [0.6, 0.0, 0.0, 0.8]


def test_inertia_as_a_list_of_nine():
    scene = parse_scene('bodies: {b: {shape: rigid, mass: 1, inertia: [2, 3, 4]}}')
    rows = [2, 0.1, 0, 0.1, 3, 0, 0, 0, 4]
    changed = with_values(scene, {'b.inertia': rows})
    assert changed.bodies[0].inertia == ((2.0, 0.1, 0.0), (0.1, 3.0, 0.0), (0.0, 0.0, 4.0))
    assert get_value(changed, 'b.inertia') == rows
    assert get_value(with_values(changed, {'b.inertia': 5}), 'b.inertia') == 5.0


@pytest.mark.parametrize('name, hint', [
    ('sphere.mas', "did you mean 'sphere.mass'"), ('spring.stifness', "mean 'spring.stiffness'"),
    ('gravty', "did you mean 'gravity'"), ('air.drag', 'air.linear_drag'), ('', 'known are: '),
    ('sphere.name', ''), ('spring.from_', ''), ('name', '')])
def test_unknown_names(name, hint):
    for use in (lambda: get_value(SCENE, name), lambda: with_values(SCENE, {name: 1})):
        with pytest.raises(SceneError, match='is no quantity of this scene') as caught:
            use()
        assert hint in str(caught.value)


def test_all_or_none():
    with pytest.raises(SceneError, match='spring.stiffness: -1 N/m'):
        with_values(SCENE, {'sphere.mass': 2, 'spring.stiffness': -1})
    with pytest.raises(SceneError, match='mass: None is not a number'):
        with_values(SCENE, {'sphere.mass': None})
