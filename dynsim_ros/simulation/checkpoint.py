# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
A run at one instant as a text from which it goes on to the same bits, anywhere.

A JSON object; numbers are written so that every bit comes back. docs/rerunning.md describes it.
"""

from dataclasses import asdict
import json

from .settings import Settings
from .simulator import Simulator
from .state_hash import state_hash
from ..scene import SceneError
from ..scene.yaml_file import parse_scene, scene_to_yaml

FORMAT, VERSION = 'dynsim_ros checkpoint', 2


class CheckpointError(ValueError):
    """A text from which no run can go on; one line."""


def checkpoint(simulator):
    """Return the text for where a Simulator stands."""
    values = {'format': FORMAT, 'version': VERSION, 'hash': state_hash(simulator.snapshot()),
              'scene': scene_to_yaml(simulator.scene), 'settings': asdict(simulator.settings),
              **simulator.memory()}
    # A line for each, for those who look.
    lines = (f'{json.dumps(name)}: {json.dumps(value, allow_nan=False)}'
             for name, value in values.items())
    return '{' + ',\n '.join(lines) + '}\n'


def restored(text, what='the checkpoint'):
    """Return a Simulator that stands where one stood; CheckpointError names `what`."""
    try:
        values = json.loads(text)
        version = values['version'] if values['format'] == FORMAT else None
    except (ValueError, KeyError, TypeError, RecursionError):
        version = None
    if version is None:
        raise CheckpointError(f'{what} is no checkpoint of a run')
    if version != VERSION:
        raise CheckpointError(f'{what} has version {version!r}, only {VERSION} can be read: use '
                              'the version of dynsim_ros that wrote it')
    try:
        simulator = Simulator(parse_scene(values['scene']), Settings(**values['settings']))
        simulator.recall(values)
        found = state_hash(simulator.snapshot())
    except SceneError as error:
        raise CheckpointError(f'{what} is damaged: {error}') from None
    except (ValueError, KeyError, TypeError, AttributeError, OverflowError) as error:
        raise CheckpointError(f'{what} is damaged: {type(error).__name__}: {error}') from None
    if found != values.get('hash'):
        raise CheckpointError(f'{what} is damaged: its state does not have the hash that it names')
    return simulator
