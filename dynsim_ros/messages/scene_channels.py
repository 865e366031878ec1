# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The topics of a scene: poses, twists, wrenches, energy, markers. Only those that it has."""

from __future__ import annotations

import struct

from .cdr import encode, Template
from .channel import Channel, stamp, WORLD
from .markers import marker_channel
from ..scene import Rigid
from ..scene.orientation import to_ros

POSE = 'geometry_msgs/msg/PoseStamped'
TWIST = 'geometry_msgs/msg/TwistStamped'
WRENCH = 'geometry_msgs/msg/WrenchStamped'
ARRAY = 'std_msgs/msg/Float64MultiArray'
ENERGIES = ('kinetic', 'gravitational', 'spring', 'total', 'work_damper', 'work_air',
            'work_anchor', 'work_push', 'imbalance')
# What stands where a message has a field for what a particle or an anchor does not have.
_NO_ROTATION = (0.0, 0.0, 0.0)
_IDENTITY = (0.0, 0.0, 0.0, 1.0)


def scene_channels(scene, layout):
    """Return the Channels of a scene; layout: Layout of its arrays."""
    channels = []
    for body in scene.bodies:
        channels += [_pose(body, layout), _twist(body, layout)]
        channels += [_wrench(kind, body, layout) for kind in wrench_kinds(scene, body)]
    channels += [_anchor_pose(anchor, i) for i, anchor in enumerate(scene.anchors)]
    return [*channels, _energy(), marker_channel(scene)]


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


def _stamped(type_name):
    return Template(type_name, {'header': {'frame_id': WORLD}}).pack


def _pose(body, layout):
    pack, position = _stamped(POSE), layout.position(body.name)
    orientation = layout.orientation(body.name)

    def encode_pose(snapshot, stamp_ns):
        y = snapshot.state
        q = _IDENTITY if orientation is None else to_ros(y[orientation].tolist())
        return pack(*stamp(stamp_ns), *y[position].tolist(), *q)

    return Channel(f'{body.name}/pose', POSE, encode_pose)


def _twist(body, layout):
    pack, velocity = _stamped(TWIST), layout.velocity(body.name)
    angular_velocity = layout.angular_velocity(body.name)

    def encode_twist(snapshot, stamp_ns):
        y = snapshot.state
        omega = _NO_ROTATION if angular_velocity is None else y[angular_velocity].tolist()
        return pack(*stamp(stamp_ns), *y[velocity].tolist(), *omega)

    return Channel(f'{body.name}/twist', TWIST, encode_twist)


def _wrench(kind, body, layout):
    pack, force = _stamped(WRENCH), layout.velocity(body.name)
    torque = layout.angular_velocity(body.name)

    def encode_wrench(snapshot, stamp_ns):
        row = snapshot.force_row(kind)
        moment = _NO_ROTATION if torque is None else row[torque].tolist()
        return pack(*stamp(stamp_ns), *row[force].tolist(), *moment)

    return Channel(f'{body.name}/wrench/{kind}', WRENCH, encode_wrench)


def _anchor_pose(anchor, i):
    pack = _stamped(POSE)

    def encode_anchor(snapshot, stamp_ns):
        return pack(*stamp(stamp_ns), *snapshot.anchors[i, :3].tolist(), *_IDENTITY)

    return Channel(f'{anchor.name}/pose', POSE, encode_anchor)


def _energy():
    # The numbers are the end of the message; what stands before them never changes.
    size = len(ENERGIES)
    dimension = {'label': ', '.join(ENERGIES) + ' [J]', 'size': size, 'stride': size}
    template = encode(ARRAY, {'layout': {'dim': [dimension]}, 'data': [0.0] * size})
    numbers = struct.Struct(f'<{size}d')
    fixed = template[:-numbers.size]

    def encode_energy(snapshot, _):
        e = snapshot.energy
        return fixed + numbers.pack(e.kinetic, e.gravitational, e.spring, e.total,
                                    *e.work.values(), e.imbalance)

    return Channel('energy', ARRAY, encode_energy)
