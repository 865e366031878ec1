# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded run as one HTML file that plays by itself."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from .recorded import space_of
from .server import serving, ViewError
from .stage import Stage

# Pictures per second of the run, at most so many in all.
_RATE, _MOST = 30.0, 9000


def export(run, path):
    """
    Write the 3-D view of a RecordedRun as an HTML file; return its size in bytes.

    It holds viser's viewer, which plays the motion; it needs no server and no network.
    """
    path = Path(path)
    _check(path)
    with serving('127.0.0.1', None, run.scene.name) as server:
        space = space_of(run)
        space.look(server.initial_camera)
        stage = Stage(server.scene, run.scene, space, run.tables)
        duration = float(run.end - run.start)
        count = int(np.clip(duration * _RATE, 1, _MOST))
        recording = server.get_scene_serializer()
        for time in np.linspace(run.start, run.end, count + 1):
            stage.show({topic: table.at(time) for topic, table in run.tables.items()})
            stage.draw_trails(run.tables, time)
            recording.insert_sleep(duration / count)
        content = recording.as_html().encode()
    path.write_bytes(content)
    return len(content)


def _check(path):
    """Raise ViewError, before the work and not after it, where a file cannot be written."""
    if path.suffix.lower() not in ('.html', '.htm'):
        raise ViewError(f'--output: {path} is no name of an HTML page; let it end in .html')
    if not os.access(path.parent, os.W_OK):
        raise ViewError(f'--output: {path.parent} is no folder that can be written to; choose '
                        'another one')
