# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Timed commands from a YAML file: what a run is, beside its scene.

A list, each entry with a time [s] and one of
  {time: 1.0, anchor: NAME, position: [x, y, z]}                    m, in world
  {time: 1.0, body: NAME, force: [x, y, z], torque: [x, y, z]}      N, N m, in world
  {time: 1.0, set: {NAME: VALUE, ...}}                              as a group, all or none
A command takes effect at the first tick at or after its time.
"""

from pathlib import Path

from .changes import changed
from .commands import checked, CommandError, MoveAnchor, PushBody, SetValues
from .settings import SECOND, Settings
from ..scene import did_you_mean, load_yaml, Quantity, SceneError, shown

_TIME = Quantity('s', 'time of a command', minimum=0.0, maximum=1e9)
_FIELDS = {'anchor': ('position',), 'body': ('force', 'torque'), 'set': ()}


def read_commands(path, scene):
    """Return [(time_ns, command)] in order of time; CommandError names the file and the entry."""
    try:
        entries = load_yaml(Path(path).read_text(encoding='utf-8'))
    except OSError as error:
        raise CommandError(f'{path}: cannot be read: {error.strerror}') from None
    except UnicodeDecodeError:
        raise CommandError(f'{path}: is no text file') from None
    except SceneError as error:
        raise CommandError(f'{path}: {error}') from None
    if not isinstance(entries, list):
        raise CommandError(f'{path}: is not a list of commands, each beginning with "- time:"')
    commands = []
    for number, entry in enumerate(entries, 1):
        try:
            commands.append(_command(entry, scene))
        except SceneError as error:
            raise CommandError(f'{path}: command {number}: {error}') from None
    return sorted(commands, key=lambda timed: timed[0])


def _command(entry, scene):
    if not isinstance(entry, dict):
        raise CommandError(f'{shown(entry)} is not a mapping such as '
                           '{time: 1, anchor: hand, position: [0, 0, 2]}')
    kind = next((kind for kind in _FIELDS if kind in entry), None)
    if kind is None or 'time' not in entry:
        raise CommandError(f'{shown(entry)} has no time, or none of ' + ', '.join(_FIELDS))
    known = ('time', kind, *_FIELDS[kind])
    for field in entry:
        if field not in known:
            raise CommandError(f'there is no field {shown(field)}; ' + did_you_mean(field, known))
    time_ns = round(_TIME.check('time', entry['time']) * SECOND)
    if kind == 'anchor':
        command = MoveAnchor(entry['anchor'], entry.get('position'))
    elif kind == 'body':
        zero = (0.0, 0.0, 0.0)
        command = PushBody(entry['body'], entry.get('force', zero), entry.get('torque', zero))
    elif isinstance(entry['set'], dict):
        changed(scene, Settings(), entry['set'])
        command = SetValues(entry['set'])
    else:
        raise CommandError(f'set: {shown(entry["set"])} is not a mapping of names to values')
    return time_ns, checked(command, scene)
