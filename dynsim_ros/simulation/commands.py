# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What can be commanded while a scene runs; a command takes effect at a tick boundary."""

from dataclasses import dataclass, field

from ..scene import did_you_mean, Quantity, Rigid, SceneError

_POSITION = Quantity('m', 'commanded position', 'vector', -1e6, 1e6)
_FORCE = Quantity('N', 'commanded force', 'vector', -1e9, 1e9)
_TORQUE = Quantity('N m', 'commanded torque', 'vector', -1e9, 1e9)


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
class SetValues:
    """Change quantities of the scene and settings of the run, all of them or none."""

    values: dict = field(default_factory=dict)


def checked(command, scene):
    """Return the command with its numbers in canonical form; raise CommandError."""
    try:
        if isinstance(command, MoveAnchor):
            _must_be_in('anchor', command.anchor, [anchor.name for anchor in scene.anchors])
            position = _POSITION.check(f'{command.anchor}: position', command.position)
            return MoveAnchor(command.anchor, position)
        if isinstance(command, PushBody):
            return _checked_push(command, scene)
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


def _must_be_in(kind, name, known):
    if name not in known:
        raise CommandError(f"'{name}' is no {kind} of this scene; " + did_you_mean(name, known))
