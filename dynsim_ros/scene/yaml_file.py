# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes as YAML files: load, and write back."""

from dataclasses import fields, MISSING
from pathlib import Path

import yaml

from .air import Air
from .bodies import Box, Particle, RigidBody, Sphere
from .connections import Anchor, Spring
from .errors import did_you_mean, SceneError, shown
from .orientation import from_axis_angle, from_ros, to_ros
from .quantity import Quantity
from .safe_yaml import load_yaml
from .scene import Scene

SHAPES = {'particle': Particle, 'sphere': Sphere, 'box': Box, 'rigid': RigidBody}
_AXIS = Quantity('', 'axis of rotation in world', kind='direction')
_ANGLE = Quantity('rad', 'angle of rotation')


def read_scene(path):
    """Return the Scene in a YAML file; SceneError names the file and what is wrong with it."""
    path = Path(path)
    try:
        return parse_scene(path.read_text(encoding='utf-8'), path.stem)
    except SceneError as error:
        raise SceneError(f'{path}: {error}') from None
    except OSError as error:
        raise SceneError(f'{path}: cannot be read: {error.strerror}') from None
    except UnicodeDecodeError:
        raise SceneError(f'{path}: is no text file') from None


def parse_scene(text, name='scene'):
    """Return the Scene in a YAML text; name is used where the text gives none."""
    data = load_yaml(text)
    known = ('name', 'description', 'gravity', 'down', 'air', 'anchors', 'bodies', 'springs')
    data = _mapping('the scene', data, known)
    for key in ('name', 'description'):
        if not isinstance(data.get(key, ''), str):
            raise SceneError(f'{key}: {shown(data[key])} is not text; put it in quotes')
    settings = {key: data[key] for key in ('description', 'gravity', 'down')
                if data.get(key) is not None}
    air = data.get('air')
    return Scene(
        name=data.get('name', name),
        bodies=_members('bodies', data, _body), anchors=_members('anchors', data, _anchor),
        springs=_members('springs', data, _spring),
        air=None if air is None else _build(Air, 'air', air), **settings)


def scene_to_yaml(scene):
    """Return the YAML text from which the same scene is read."""
    data = {'name': scene.name}
    if scene.description:
        data['description'] = scene.description
    if scene.gravity is not None:
        data |= {'gravity': scene.gravity, 'down': list(scene.down)}
    if scene.air is not None:
        data['air'] = _plain(scene.air)
    for section in ('anchors', 'bodies', 'springs'):
        if getattr(scene, section):
            data[section] = {m.name: _plain(m) for m in getattr(scene, section)}
    return yaml.safe_dump(data, sort_keys=False, default_flow_style=None, width=99)


def _plain(member):
    names = {cls: shape for shape, cls in SHAPES.items()}
    plain = {'shape': names[type(member)]} if type(member) in names else {}
    for field in fields(member):
        value = getattr(member, field.name)
        if field.name == 'name' or value is None:
            continue
        if field.name == 'orientation':
            value = to_ros(value)
        if isinstance(value, tuple):
            value = [list(row) if isinstance(row, tuple) else row for row in value]
        plain[field.name.rstrip('_')] = value
    return plain


def _mapping(where, data, known):
    if not isinstance(data, dict):
        raise SceneError(f'{where}: {shown(data)} is not a mapping of names to values')
    for key in data:
        if key not in known:
            raise SceneError(f'{where}: there is no field {shown(key)}; '
                             + did_you_mean(key, known))
    return data


def _members(section, data, build):
    members = data.get(section)
    if members is None:
        return ()
    if not isinstance(members, dict):
        raise SceneError(f'{section}: {shown(members)} is not a mapping of names to members')
    return tuple(build(name, member) for name, member in members.items())


def _body(name, data):
    shape = data.get('shape') if isinstance(data, dict) else None
    if not isinstance(shape, str) or shape not in SHAPES:
        hint = did_you_mean(shape, SHAPES) if shape else 'known are: ' + ', '.join(SHAPES)
        raise SceneError(f'{name}.shape: {shown(shape)} is no shape; {hint}')
    data = {key: value for key, value in data.items() if key != 'shape'}
    if 'orientation' in data:
        data['orientation'] = _orientation(f'{name}.orientation', data['orientation'])
    return _build(SHAPES[shape], name, data, name=name)


def _anchor(name, data):
    return _build(Anchor, name, data, name=name)


def _spring(name, data):
    return _build(Spring, name, data, name=name)


def _build(cls, where, data, **given):
    known = {f.name.rstrip('_'): f for f in fields(cls) if f.name not in given}
    data = _mapping(where, data, known)
    for key, field in known.items():
        required = field.default is MISSING
        if data.get(key) is None and (required or key in data):
            unit = field.metadata['quantity'].unit if 'quantity' in field.metadata else ''
            raise SceneError(f'{where}.{key}: is missing; give it'
                             + (f' in {unit}' if unit else ''))
    return cls(**given, **{known[key].name: value for key, value in data.items()})


def _orientation(where, value):
    """Return (w, x, y, z) from a mapping (w, x, y, z or axis, angle) or a list x y z w."""
    if isinstance(value, list) and len(value) == 4:
        return from_ros(value)
    if isinstance(value, dict) and set(value) == {'w', 'x', 'y', 'z'}:
        return tuple(value[key] for key in 'wxyz')
    if isinstance(value, dict) and set(value) == {'axis', 'angle'}:
        axis = _AXIS.check(f'{where}.axis', value['axis'])
        return from_axis_angle(axis, _ANGLE.check(f'{where}.angle', value['angle']))
    raise SceneError(f'{where}: {shown(value)} is no orientation; give {{axis: [x, y, z], '
                     'angle: rad}, {w: , x: , y: , z: } or a list x, y, z, w')
