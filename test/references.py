# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The reference trajectories in reference/, and how far a motion is from one.

How they came about, and how they were verified, is in reference/make_references.py.
"""

import functools
import json
from pathlib import Path

from dynsim_ros.scene import load_scene, parse_scene, scene_names
import numpy as np

FOLDER = Path(__file__).with_name('reference')
FILE = FOLDER / 'references.json'


@functools.cache
def all_scenes():
    """Return {name: Scene} of the scenes that have a reference: our own, then the package's."""
    texts = FOLDER.joinpath('scenes.yaml').read_text(encoding='utf-8').split('\n---\n')
    own = {scene.name: scene for scene in map(parse_scene, texts)}
    return own | {name: load_scene(name) for name in scene_names()}


@functools.cache
def _data():
    return json.loads(FILE.read_text(encoding='utf-8'))


def scenes():
    """Return the names of the scenes that have a reference."""
    return list(_data())


def load(name):
    """
    Return (Scene, times, motions).

    times: list of seconds; motions: for each time {body: (r, v) or (r, v, q, omega)} in world, as
    float arrays, q = (w, x, y, z).
    """
    data = _data()[name]
    motions = [{body: tuple(np.array(part, dtype=float) for part in parts)
                for body, parts in motion.items()} for motion in data['motions']]
    return all_scenes()[name], data['times'], motions


def amplification(name):
    """Return how many times larger a tiny error of the initial values becomes, at worst."""
    return _data()[name]['amplification']


def error(now, motion):
    """
    Return the error of a Snapshot, or of a State, against the motion at its time.

    The largest of |dr|, |dv|, angle of rotation and |domega| of any body, each over max(1, size
    of that part of the motion). Not a number if any of it is none.
    """
    found = []
    for body, (r, v, *turning) in motion.items():
        pairs = [(now.position(body), r), (now.velocity(body), v)]
        if turning:
            pairs.append((now.angular_velocity(body), turning[1]))
            found.append(angle(now.orientation(body), turning[0]))
        found += [np.linalg.norm(ours - theirs) / max(1.0, np.linalg.norm(theirs))
                  for ours, theirs in pairs]
    return float(np.max(found))


def angle(p, q):
    """Return the angle [rad] of the rotation between two quaternions (w, x, y, z)."""
    p, q = p / np.linalg.norm(p), q / np.linalg.norm(q)
    # not from p @ q, which loses half the digits near 1
    return 4.0 * np.arcsin(np.minimum(
        1.0, 0.5 * np.minimum(np.linalg.norm(p - q), np.linalg.norm(p + q))))


class State:
    """A state array as error wants it; layout: the simulation's Layout of the scene."""

    def __init__(self, layout, y):
        self._layout, self._y = layout, y

    def position(self, body):
        return self._y[self._layout.position(body)]

    def velocity(self, body):
        return self._y[self._layout.velocity(body)]

    def orientation(self, body):
        return self._y[self._layout.orientation(body)]

    def angular_velocity(self, body):
        return self._y[self._layout.angular_velocity(body)]
