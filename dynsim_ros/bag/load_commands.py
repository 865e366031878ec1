# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The commands of a run out of its messages: what messages.commands made of them, undone."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace

from ..messages.commands import anchor_topic, PARAMETER_TOPIC, push_topic
from ..scene import Scene
from ..simulation.commands import MoveAnchor, PlaceBody, PushBody, setting, SetValues

# Where an rcl_interfaces/ParameterValue of each type has its value.
_VALUES = {1: 'bool_value', 2: 'integer_value', 3: 'double_value', 4: 'string_value',
           8: 'double_array_value'}
Command = MoveAnchor | PushBody | PlaceBody | SetValues


def command_makers(scene: Scene) -> dict[str, Callable[[dict], Command]]:
    """Return {topic, relative to the node: what makes a command of its message, a dict}."""
    makers = {PARAMETER_TOPIC: lambda message: setting(_value(message), scene)}
    for anchor in scene.anchors:
        makers[anchor_topic(anchor.name)] = (
            lambda message, name=anchor.name: MoveAnchor(name, _xyz(message['point'])))
    for body in scene.bodies:
        makers[push_topic(body.name)] = lambda message, name=body.name: PushBody(
            name, _xyz(message['wrench']['force']), _xyz(message['wrench']['torque']))
    return makers


def grouped(commands: Iterable[tuple[int, Command]]) -> list[tuple[int, Command]]:
    """Return [(time, command)]; values set one behind the other at one time are one command."""
    found = []
    for time_ns, command in commands:
        if found and found[-1][0] == time_ns and _are_one(found[-1][1], command):
            command = replace(command, values={**found.pop()[1].values, **command.values})
        found.append((time_ns, command))
    return found


def _are_one(last, command):
    """Tell whether two commands set values of the same: parameters, or one body's state."""
    return (isinstance(command, PlaceBody | SetValues) and isinstance(last, type(command))
            and replace(last, values={}) == replace(command, values={}))


def _value(message):
    value = message['value']
    return {message['name']: value[_VALUES[value['type']]]}


def _xyz(vector):
    return vector['x'], vector['y'], vector['z']
