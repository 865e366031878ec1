# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Commands as the messages that they arrive in and are recorded as."""

from __future__ import annotations

from .cdr import decode, encode
from .channel import header
from ..simulation.commands import MoveAnchor, PlaceBody, PushBody, setting, SetValues

POINT = 'geometry_msgs/msg/PointStamped'
WRENCH = 'geometry_msgs/msg/WrenchStamped'
PARAMETER = 'rcl_interfaces/msg/Parameter'
PARAMETER_TOPIC = 'parameter_command'
# How many of the parameters that follow were set as one group, where it is more than one.
GROUP = 'std_msgs/msg/UInt32'
GROUP_TOPIC = 'parameter_group'
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


def recorded_command_topics(scene):
    """Return {topic: type name} of all that command_messages can return."""
    return {**command_topics(scene), GROUP_TOPIC: GROUP}


def command_messages(command, stamp_ns):
    """Return [(topic, CDR bytes)] for a command that took effect at a time [ns]."""
    if isinstance(command, MoveAnchor):
        message = {'header': header(stamp_ns), 'point': _xyz(command.position)}
        return [(anchor_topic(command.anchor), encode(POINT, message))]
    if isinstance(command, PushBody):
        wrench = {'force': _xyz(command.force), 'torque': _xyz(command.torque)}
        message = {'header': header(stamp_ns), 'wrench': wrench}
        return [(push_topic(command.body), encode(WRENCH, message))]
    if isinstance(command, PlaceBody):
        values = {f'{command.body}.{part}': value for part, value in command.values.items()}
    else:
        assert isinstance(command, SetValues), command
        values = command.values
    group = [(GROUP_TOPIC, encode(GROUP, {'data': len(values)}))] if len(values) > 1 else []
    return group + [
        (PARAMETER_TOPIC, encode(PARAMETER, {'name': name, 'value': parameter_value(value)}))
        for name, value in values.items()]


def command_of(topic, messages, scene):
    """
    Return the command that was recorded as messages, CDR bytes, on one of command_topics.

    Several messages are parameters that were set as a group; those of a body's state, which no
    parameter is once the run has begun, are where it was put. Raises ValueError for what is none.
    """
    if topic == PARAMETER_TOPIC:
        parameters = [decode(PARAMETER, data) for data in messages]
        return setting({parameter['name']: value_of(parameter['value'])
                        for parameter in parameters}, scene)
    (data,) = messages
    name = topic.partition('/')[0]
    if topic == anchor_topic(name):
        return MoveAnchor(name, _numbers(decode(POINT, data)['point']))
    wrench = decode(WRENCH, data)['wrench']
    return PushBody(name, _numbers(wrench['force']), _numbers(wrench['torque']))


def group_size(data):
    """Return how many parameters that follow are a group, of CDR bytes on GROUP_TOPIC."""
    return decode(GROUP, data)['data']


def parameter_value(value):
    """Return a value as an rcl_interfaces/ParameterValue."""
    if isinstance(value, bool):
        return {'type': _BOOL, 'bool_value': value}
    if isinstance(value, str):
        return {'type': _STRING, 'string_value': value}
    if hasattr(value, '__len__'):
        return {'type': _DOUBLE_ARRAY, 'double_array_value': [float(a) for a in value]}
    return {'type': _DOUBLE, 'double_value': float(value)}


def value_of(value):
    """Return what parameter_value was given, lists for sequences."""
    field = {_BOOL: 'bool_value', _STRING: 'string_value', _DOUBLE_ARRAY: 'double_array_value',
             _DOUBLE: 'double_value'}.get(value['type'])
    if field is None:
        raise ValueError(f'a parameter of type {value["type"]} is none of a run')
    return value[field]


def _numbers(xyz):
    return (xyz['x'], xyz['y'], xyz['z'])


def _xyz(a):
    return dict(zip('xyz', a))
