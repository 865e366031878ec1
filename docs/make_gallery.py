# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Draw a small picture of every scene that comes with the package, computed without ROS.

    python docs/make_gallery.py [--output FOLDER] [SCENE ...]

Needs matplotlib and Pillow besides dynsim_ros.
"""

import argparse
from pathlib import Path
from typing import NamedTuple

from drawing import (AXES, AZIMUTH, draw_box, draw_sphere, draw_spring, draw_trail, ELEVATION,
                     end_of_spring, INK, PALE, PAPER, save, STYLE, viewing_direction)
from dynsim_ros.scene import Box, load_scene, scene_names, Sphere
from dynsim_ros.simulation import Simulator
from matplotlib import rc_context
from matplotlib.figure import Figure
import numpy as np


class View(NamedTuple):
    """When a scene is drawn [s], how large, how long a trail [s], how far apart dots on it [s]."""

    instant: float = 2.8
    zoom: float = 1.05
    trail: float = 2.5
    every: float = 0.0


VIEWS = {'particle_on_spring': View(2.6, 1.05, 2.6),
         'double_pendulum_of_spheres': View(1.9, 1.08, 1.9),
         'falling_in_wind': View(1.85, 0.85, 1.85, 0.1), 'two_anchors': View(1.2, 1.1, 1.2),
         'spinning_box': View(3.4, 1.05, 0.0)}


def main():
    parser = argparse.ArgumentParser(description='Draw a small picture of every scene.')
    parser.add_argument('scenes', nargs='*', metavar='SCENE', default=scene_names())
    parser.add_argument('--output', type=Path, default=Path(__file__).with_name('gallery'))
    options = parser.parse_args()
    options.output.mkdir(exist_ok=True)
    for name in options.scenes:
        draw(name, VIEWS.get(name, View()), options.output / f'{name}.png')


def draw(name, view, path):
    """Draw one scene, with its trail and its springs, above a floor with squares."""
    scene = load_scene(name)
    run = Simulator(scene).run(view.instant)
    with rc_context(STYLE):
        figure = Figure(figsize=(3.6, 3.2), dpi=130)
        picture = figure.add_axes((-0.1, -0.1, 1.2, 1.2), projection='3d', computed_zorder=False)
        low, high = room(scene, run)
        draw_floor(picture, low, high)
        first = int(np.searchsorted(run.time, view.instant - view.trail))
        for body in scene.bodies:
            if view.trail:
                draw_trail(picture, run.position(body.name)[first:], low[2])
            if view.every:
                for i in range(first, len(run.time), round(view.every * 100)):
                    picture.scatter(*run.position(body.name)[i], color=INK, s=10, zorder=4,
                                    depthshade=False)
        draw_members(picture, scene, run.snapshots[-1], high - low)
        picture.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
        picture.set_box_aspect(high - low, zoom=view.zoom)
        picture.view_init(elev=ELEVATION, azim=AZIMUTH)
        picture.set_axis_off()
        save(figure, path, colours=128)


def room(scene, run):
    """Return two corners, (3,) each, of what the whole motion takes up, with some space."""
    places = [run.position(body.name) for body in scene.bodies]
    places += [snapshot.anchors[:, :3] for snapshot in run.snapshots]
    places = np.vstack(places)
    reach = max(extent(body) for body in scene.bodies)
    low, high = places.min(axis=0) - 1.3 * reach, places.max(axis=0) + 1.3 * reach
    # Not too thin a slice: the eye looks from the side.
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    half[:2] = np.maximum(half[:2], 0.3 * half.max())
    return middle - half, middle + half


def extent(body):
    """Return how far a body reaches from its centre [m]."""
    if isinstance(body, Sphere):
        return body.radius
    return 0.5 * np.linalg.norm(body.size) if isinstance(body, Box) else 0.03


def draw_floor(picture, low, high):
    """Draw squares of 0.1, 1, … m on the floor."""
    square = 10.0 ** np.floor(np.log10((high - low).max() / 3))
    for axis in range(2):
        for at in np.arange(np.ceil(low[axis] / square), high[axis] / square) * square:
            ends = np.array([low, high])[:, :2]
            ends[:, axis] = at
            picture.plot(*ends.T, low[2], color=PALE, lw=0.7, zorder=0)


def draw_members(picture, scene, snapshot, size):
    """Draw bodies, anchors and springs, the farther ones first."""
    towards, draws = viewing_direction(), []
    for body in scene.bodies:
        draws.append((snapshot.position(body.name), draw_body, body))
    for spring in scene.springs:
        ends = [end_of_spring(snapshot, name, offset) for name, offset in (
            (spring.from_, spring.from_offset), (spring.to, spring.to_offset))]
        draws.append((np.mean(ends, axis=0), draw_between, ends))
    for layer, (_, draw_it, what) in enumerate(sorted(draws, key=lambda d: d[0] @ towards)):
        draw_it(picture, snapshot, what, 5 + 4 * layer)
    for anchor in scene.anchors:
        picture.scatter(*snapshot.anchor_position(anchor.name), color=AXES[0], marker='s', s=45,
                        zorder=100, depthshade=False)


def draw_body(picture, snapshot, body, zorder):
    """Draw a sphere, a box, or a particle as a dot."""
    centre, q = snapshot.position(body.name), snapshot.orientation(body.name)
    if isinstance(body, Sphere):
        draw_sphere(picture, centre, q, body.radius, zorder)
    elif isinstance(body, Box):
        draw_box(picture, centre, q, body.size, zorder)
    else:
        picture.scatter(*centre, color=AXES[2], s=60, zorder=zorder, depthshade=False,
                        edgecolors=PAPER)


def draw_between(picture, _, ends, zorder):
    """Draw a spring between two points."""
    draw_spring(picture, *ends, zorder, turns=round(12 * np.linalg.norm(ends[1] - ends[0])) or 1,
                radius=0.03)


if __name__ == '__main__':
    main()
