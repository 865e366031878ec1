# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Commands as the messages that they arrive in and are recorded as."""

from __future__ import annotations

from .cdr import encode
from .channel import header
from ..simulation.commands import MoveAnchor, PushBody, SetValues

POINT = 'geometry_msgs/msg/PointStamped'
WRENCH = 'geometry_msgs/msg/WrenchStamped'
PARAMETER = 'rcl_interfaces/msg/Parameter'
PARAMETER_TOPIC = 'parameter_command'
_BOOL, _DOUBLE, _STRING, _DOUBLE_ARRAY = 1, 3, 4, 8


def anchor_topic(anchor):
    """Return the topic, relative to the node, that moves an anchor."""
    return f'{anchor}/command'


def push_topic(body):
    """Return the topic, relative to the node, that pushes a body."""
    return f'{body}/wrench_command'


def command_topics(scene):
    """Return {topic: type name} of all commands that a scene takes."""
    return {**{anchor_topic(anchor.name): POINT for anchor in scene.anchors},
            **{push_topic(body.name): WRENCH for body in scene.bodies},
            PARAMETER_TOPIC: PARAMETER}


def command_messages(command, stamp_ns):
    """Return [(topic, CDR bytes)] for a command that took effect at a time [ns]."""
    if isinstance(command, MoveAnchor):
        message = {'header': header(stamp_ns), 'point': _xyz(command.position)}
        return [(anchor_topic(command.anchor), encode(POINT, message))]
    if isinstance(command, PushBody):
        wrench = {'force': _xyz(command.force), 'torque': _xyz(command.torque)}
        message = {'header': header(stamp_ns), 'wrench': wrench}
        return [(push_topic(command.body), encode(WRENCH, message))]
    assert isinstance(command, SetValues), command
    return [(PARAMETER_TOPIC, encode(PARAMETER, {'name': name, 'value': parameter_value(value)}))
            for name, value in command.values.items()]


def parameter_value(value):
    """Return a value as an rcl_interfaces/ParameterValue."""
    if isinstance(value, bool):
        return {'type': _BOOL, 'bool_value': value}
    if isinstance(value, str):
        return {'type': _STRING, 'string_value': value}
    if hasattr(value, '__len__'):
        return {'type': _DOUBLE_ARRAY, 'double_array_value': [float(a) for a in value]}
    return {'type': _DOUBLE, 'double_value': float(value)}


def _xyz(a):
    return dict(zip('xyz', a))
