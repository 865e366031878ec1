# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The quantities of a scene by name: '<member>.<field>', 'air.<field>', 'gravity', 'down'.

The same names are ROS parameters, '--set' on the command line and changes in a command file.
"""

from dataclasses import replace

from .bodies import Rigid
from .errors import did_you_mean, SceneError, shown
from .orientation import from_ros, to_ros
from .quantity import quantities_of


def scene_quantities(scene):
    """Return {name: Quantity} of every quantity that the scene has; what it lacks is absent."""
    found = {prefix + field: quantity for prefix, owner in _owners(scene).items()
             for field, quantity in quantities_of(owner).items()}
    if scene.gravity is None:
        del found['down']
    if scene.air is not None and not any(isinstance(body, Rigid) for body in scene.bodies):
        found.pop('air.rotational_drag', None)
        found.pop('air.angular_velocity', None)
    return found


def get_values(scene):
    """
    Return {name: value} of every quantity, as users write it: see get_value.

    Meant for many: one get_value after another takes a time that grows as the square.
    """
    owners = _owners(scene)
    return {name: _plain(owners, name, quantity)
            for name, quantity in scene_quantities(scene).items()}


def get_value(scene, name):
    """
    Return a quantity as users write it: a float or a list of floats, quaternions x y z w.

    A 3 x 3 inertia comes as a list of nine, row by row.
    """
    return _plain(_owners(scene), name, _known(scene_quantities(scene), name))


def with_values(scene, changes):
    """
    Return the scene with some quantities changed, all of them or (SceneError) none.

    changes: {name: value as users write it}.
    """
    members = {member.name: {} for member in scene.members}
    members['air'] = {}
    members[''] = {}
    quantities = scene_quantities(scene)
    for name, value in changes.items():
        quantity = _known(quantities, name)
        owner, _, field = name.rpartition('.')
        members[owner][field] = _given(name, quantity, value)

    def changed(member):
        return replace(member, **members[member.name]) if members[member.name] else member

    return replace(
        scene, bodies=tuple(map(changed, scene.bodies)),
        anchors=tuple(map(changed, scene.anchors)), springs=tuple(map(changed, scene.springs)),
        air=replace(scene.air, **members['air']) if members['air'] else scene.air, **members[''])


def _given(name, quantity, value):
    """Return a value as users write it in the form that the scene's dataclasses take."""
    if value is None:
        # In a scene None is what is absent; what is there cannot be taken away by a value.
        return quantity.check(name, value)
    if quantity.kind == 'orientation':
        if not isinstance(value, (list, tuple)) and not hasattr(value, 'tolist'):
            raise SceneError(f'{name}: {shown(value)} is not a list of 4 numbers x, y, z, w')
        return from_ros(value) if len(value) == 4 else value
    if quantity.kind == 'inertia' and hasattr(value, '__len__') and len(value) == 9:
        return tuple(tuple(value[3 * row:3 * row + 3]) for row in range(3))
    return value


def _known(quantities, name):
    if name not in quantities:
        raise SceneError(f"'{name}' is no quantity of this scene; "
                         + did_you_mean(name, quantities))
    return quantities[name]


def _owners(scene):
    """Return {prefix of names: what has those quantities}."""
    owners = {'': scene, **{f'{member.name}.': member for member in scene.members}}
    if scene.air is not None:
        owners['air.'] = scene.air
    return owners


def _plain(owners, name, quantity):
    owner, dot, field = name.rpartition('.')
    value = getattr(owners[owner + dot], field)
    if quantity.kind == 'orientation':
        return list(to_ros(value))
    if isinstance(value, float):
        return value
    if isinstance(value[0], tuple):
        return [number for row in value for number in row]
    return list(value)
