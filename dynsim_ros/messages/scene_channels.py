# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The topics of a scene: poses, twists, wrenches, energy, frames, markers, hash. What it has."""

from __future__ import annotations

from dataclasses import replace

from .channel import Channel, WORLD
from .markers import marker_channel
from .qos import every_tick
from .row import Row
from .state_hash import STATE_HASH
from .template import Template
from .transforms import transform_channel
from ..scene import Rigid
from ..scene.orientation import to_ros
from ..simulation.rows.tick_numbers import ENERGIES, Numbers

__all__ = ['ENERGIES', 'scene_channels', 'wrench_kinds']

POSE = 'geometry_msgs/msg/PoseStamped'
TWIST = 'geometry_msgs/msg/TwistStamped'
WRENCH = 'geometry_msgs/msg/WrenchStamped'
ARRAY = 'std_msgs/msg/Float64MultiArray'
# What stands where a message has a field for what a particle or an anchor does not have.
_ZERO = {'x': 0.0, 'y': 0.0, 'z': 0.0}
_UNTURNED = {'pose': {'orientation': {**_ZERO, 'w': 1.0}}}


def scene_channels(scene, layout, node='/dynsim'):
    """Return the Channels of a scene; layout: Layout of its arrays; node: its full name."""
    channels, numbers = [], Numbers(layout)
    for body in scene.bodies:
        channels += [_pose(body, numbers), _twist(body, numbers)]
        channels += [_wrench(kind, body, numbers) for kind in wrench_kinds(scene, body)]
    channels += [_anchor_pose(anchor, numbers) for anchor in scene.anchors]
    channels.append(_energy(numbers))
    qos = every_tick(len(channels))
    channels = [replace(channel, qos=qos) for channel in channels]
    return [*channels, transform_channel(scene, node), marker_channel(scene),
            STATE_HASH]


def wrench_kinds(scene, body):
    """Return the kinds of wrench that can act on a body of a scene, then 'net'."""
    springs = [spring for spring in scene.springs if body.name in (spring.from_, spring.to)]
    air = scene.air
    present = {
        'spring': bool(springs),
        'damper': any(spring.damping is not None for spring in springs),
        'air': air is not None and (air.linear_drag is not None or (
            isinstance(body, Rigid) and air.rotational_drag is not None)),
        'gravity': scene.gravity is not None,
        'net': True,
    }
    return [kind for kind, is_present in present.items() if is_present]


def _row(topic, type_name, numbers, fixed=None):
    """Return the Channel of a stamped message; numbers: {leaf: place in Numbers}."""
    template = Template(type_name, {'header': {'frame_id': WORLD}, **(fixed or {})})
    return Channel(topic, type_name, None, row=Row(template, numbers))


def _xyz(prefix, places):
    """Return {leaf: place} of a vector, nothing where there is none."""
    return {f'{prefix}.{axis}': place for axis, place in zip('xyz', places or ())}


def _pose(body, numbers):
    position = _xyz('pose.position', numbers.position(body.name))
    orientation = numbers.orientation(body.name)
    if orientation is None:
        return _row(f'{body.name}/pose', POSE, position, _UNTURNED)
    turned = {f'pose.orientation.{axis}': place
              for axis, place in zip('xyzw', to_ros(orientation))}
    return _row(f'{body.name}/pose', POSE, {**position, **turned})


def _two_vectors(topic, type_name, names, first, second):
    """Return the Channel of two vectors; of a particle the second one is zero."""
    message = type_name.rpartition('/')[2].removesuffix('Stamped').lower()
    numbers = {**_xyz(f'{message}.{names[0]}', first), **_xyz(f'{message}.{names[1]}', second)}
    return _row(topic, type_name, numbers,
                {message: {names[1]: _ZERO}} if second is None else None)


def _twist(body, numbers):
    return _two_vectors(f'{body.name}/twist', TWIST, ('linear', 'angular'),
                        numbers.velocity(body.name), numbers.angular_velocity(body.name))


def _wrench(kind, body, numbers):
    return _two_vectors(f'{body.name}/wrench/{kind}', WRENCH, ('force', 'torque'),
                        numbers.force(kind, body.name), numbers.torque(kind, body.name))


def _anchor_pose(anchor, numbers):
    position = _xyz('pose.position', numbers.anchor_position(anchor.name))
    return _row(f'{anchor.name}/pose', POSE, position, _UNTURNED)


def _energy(numbers):
    size = len(ENERGIES)
    dimension = {'label': ', '.join(ENERGIES) + ' [J]', 'size': size, 'stride': size}
    template = Template(ARRAY, {'layout': {'dim': [dimension], 'data_offset': 0},
                                'data': [None] * size})
    return Channel('energy', ARRAY, None, row=Row(template, {
        f'data.{i}': numbers.energy(name) for i, name in enumerate(ENERGIES)}))
