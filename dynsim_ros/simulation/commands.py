# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What can be commanded while a scene runs; a command takes effect at a tick boundary."""

from dataclasses import dataclass, field

from ..scene import did_you_mean, Quantity, Rigid, scene_quantities, SceneError
from ..scene.orientation import from_ros, to_ros

_POSITION = Quantity('m', 'commanded position', 'vector', -1e6, 1e6)
_FORCE = Quantity('N', 'commanded force', 'vector', -1e9, 1e9)
_TORQUE = Quantity('N m', 'commanded torque', 'vector', -1e9, 1e9)
# What PlaceBody can set.
PLACED = ('position', 'velocity', 'orientation', 'angular_velocity')


class CommandError(SceneError):
    """A command that cannot be carried out; the state has not changed."""


@dataclass(frozen=True)
class MoveAnchor:
    """Move an anchor to a position: (3,) in world [m]."""

    anchor: str
    position: tuple


@dataclass(frozen=True)
class PushBody:
    """Push a body: force (3,) [N] and torque (3,) [N m] about its centre of mass, in world."""

    body: str
    force: tuple
    torque: tuple = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class PlaceBody:
    """
    Put a body into another state at once, in world; what is not given stays as it is.

    values: {'position': (3,) [m], 'velocity': (3,) [m/s], 'orientation': (x, y, z, w),
    'angular_velocity': (3,) [rad/s]}; the last two of a rigid body only.
    """

    body: str
    values: dict = field(default_factory=dict)


@dataclass(frozen=True)
class SetValues:
    """Change quantities of the scene and settings of the run, all of them or none."""

    values: dict = field(default_factory=dict)


def setting(values, scene):
    """Return the command that sets {name: value}, of the state of one body or of no body's."""
    quantities = scene_quantities(scene)
    for name in values:
        if name in quantities and quantities[name].initial:
            body = name.rpartition('.')[0]
            return PlaceBody(body, {name.removeprefix(f'{body}.'): value
                                    for name, value in values.items()})
    return SetValues(values)


def checked(command, scene):
    """Return the command with its numbers in canonical form; raise CommandError."""
    try:
        if isinstance(command, MoveAnchor):
            _must_be_in('anchor', command.anchor, [anchor.name for anchor in scene.anchors])
            position = _POSITION.check(f'{command.anchor}: position', command.position)
            return MoveAnchor(command.anchor, position)
        if isinstance(command, PushBody):
            return _checked_push(command, scene)
        if isinstance(command, PlaceBody):
            return _checked_place(command, scene)
    except CommandError:
        raise
    except SceneError as error:
        raise CommandError(str(error)) from None
    return command


def _checked_push(command, scene):
    _must_be_in('body', command.body, [body.name for body in scene.bodies])
    body = scene.ends[command.body]
    push = PushBody(command.body, _FORCE.check(f'{command.body}: force', command.force),
                    _TORQUE.check(f'{command.body}: torque', command.torque))
    if any(push.torque) and not isinstance(body, Rigid):
        raise CommandError(f'{command.body}: torque {list(push.torque)} N m cannot act on a '
                           'particle, which has no orientation; give a force only')
    return push


def _checked_place(command, scene):
    _must_be_in('body', command.body, [body.name for body in scene.bodies])
    quantities = scene_quantities(scene)
    known = [name for name in PLACED if f'{command.body}.{name}' in quantities]
    values = {}
    for part, value in command.values.items():
        name = f'{command.body}.{part}'
        if part not in known:
            raise CommandError(f"'{name}' is no part of the state of this body; "
                               + did_you_mean(part, known))
        turns = part == 'orientation' and hasattr(value, '__len__') and len(value) == 4
        value = quantities[name].check(name, from_ros(value) if turns else value)
        values[part] = to_ros(value) if turns else value
    return PlaceBody(command.body, values)


def _must_be_in(kind, name, known):
    if name not in known:
        raise CommandError(f"'{name}' is no {kind} of this scene; " + did_you_mean(name, known))
