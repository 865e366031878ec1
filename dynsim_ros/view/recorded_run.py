# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded run, read from its bag."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.lib.recfunctions import structured_to_unstructured

from .server import ViewError
from .table import NUMBERS, Table
from ..bag import load
from ..bag.reader import open_bag
from ..bag.run_names import RUN_METADATA, SCENE_ATTACHMENT, TOPIC_METADATA
from ..scene import parse_scene, Scene, SceneError

# What the topics of a run end with: others, such as commands, are of the same types.
_ENDINGS = ('/pose', '/twist', '/wrench/spring', '/wrench/damper', '/wrench/air',
            '/wrench/gravity', '/wrench/net', '/energy')


@dataclass(frozen=True)
class RecordedRun:
    """
    A run.

    tables: {topic relative to the node: Table}; problem: None, or one line that says what is
    wrong with the bag.
    """

    scene: Scene
    tables: dict
    problem: str | None

    @property
    def start(self):
        """Return when it begins [s]."""
        return min(table.time[0] for table in self.tables.values())

    @property
    def end(self):
        """Return when it ends [s]."""
        return max(table.time[-1] for table in self.tables.values())


def check_run(path, scene=None):
    """Raise what read_run raises, as far as that can be known without reading all messages."""
    with open_bag(path) as bag:
        scene = scene or _scene(bag)
        node = _node(bag, scene)
        _must_have_poses(path, scene, node, _names(bag, node).values())


def read_run(path, scene=None):
    """
    Return the RecordedRun in a bag; scene: to be used instead of the one in it, or None.

    Raises BagError or ViewError, in one line, where there is none.
    """
    bag = load(path)
    scene = scene or _scene(bag)
    node = _node(bag, scene)
    tables = {topic: Table(bag.time(name), _numbers(bag[name]))
              for name, topic in _names(bag, node).items()
              if name in bag and f'/{topic}'.endswith(_ENDINGS)
              and bag.channels[name].type_name in NUMBERS}
    _must_have_poses(path, scene, node, tables)
    return RecordedRun(scene, tables, bag.problem)


def _names(bag, node):
    """Return {name: topic relative to the node} of a bag, also where topics were remapped."""
    remapped = {name: topic for topic, name in bag.metadata.get(TOPIC_METADATA, {}).items()}
    return {name: remapped.get(name, name.removeprefix(f'{node}/')) for name in bag.channels
            if name in remapped or name.startswith(f'{node}/')}


def _must_have_poses(path, scene, node, topics):
    """Raise ViewError unless the pose of each body is among topics, relative to the node."""
    missing = [body.name for body in scene.bodies if f'{body.name}/pose' not in topics]
    if missing:
        raise ViewError(f'{path}: holds no pose of {", ".join(missing)} below {node or "a node"}; '
                        'record ~/<body>/pose, too')


def _numbers(values):
    """Return the numbers of messages, (n, k), without what comes before; not copied."""
    numbers = values[values.dtype.names[-1]]
    return np.asarray(structured_to_unstructured(numbers) if numbers.dtype.names else numbers,
                      float)


def _scene(bag):
    """Return the scene that is attached to a bag."""
    if SCENE_ATTACHMENT not in bag.attachments:
        raise ViewError(f'{bag.path}: holds no {SCENE_ATTACHMENT}, as runs of this package do; '
                        'give the scene of the run with --scene')
    _, content = bag.attachments[SCENE_ATTACHMENT]
    try:
        return parse_scene(content.decode('utf-8'))
    except (SceneError, UnicodeDecodeError) as error:
        raise ViewError(f'{bag.path}: its {SCENE_ATTACHMENT} is no scene: {error}') from None


def _node(bag, scene):
    """Return the name of the node whose topics a bag holds, '' for none."""
    recorded = bag.metadata.get(RUN_METADATA, {}).get('node')
    if recorded:
        return recorded
    ending = f'/{scene.bodies[0].name}/pose'
    return next((name.removesuffix(ending) for name in bag.channels if name.endswith(ending)), '')
