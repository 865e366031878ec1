# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The space that a run takes: how large to draw, where the floor is, where to look from."""

from __future__ import annotations

import math

import numpy as np

from ..scene import Box, Sphere

# A run that is so many times as large as its bodies is looked at by following one of them.
_FAR = 40.0
_FOV = math.radians(35.0)
# At most so many times as far off where the view is higher than wide. Where it is as slim as the
# page of a phone, so many sizes above the middle: the controls cover its lower part.
_FARTHEST, _SLIM, _RISE = 1.3, 0.55, 0.32


class Space:
    """
    The space of a scene.

    points: (n, 3) places that are to be seen [m]. middle: (3,) of what is to be seen [m]; size:
    its extent [m]; unit: size of its smallest part [m]; is_left: the bodies leave it, so that one
    has to be followed.
    """

    def __init__(self, scene, points):
        sizes = [max(_extent(body)) for body in scene.bodies if _extent(body)]
        lengths = [spring.natural_length for spring in scene.springs if spring.natural_length]
        self.unit = min([*sizes, *(0.2 * length for length in lengths)], default=0.1)
        low, high = np.min(points, axis=0), np.max(points, axis=0)
        extent = max(*(high - low), *sizes, 0.0)
        self.is_left = not scene.anchors and bool(sizes) and extent > _FAR * max(sizes)
        if self.is_left:
            reach = 5.0 * max(sizes)
            low, high = points[0] - reach, points[0] + reach
        self.middle = 0.5 * (low + high)
        self.size = max(*(high - low), *(1.5 * size for size in sizes), 0.5 * max(lengths or [0]),
                        self.unit)
        self.floor = min(low[2], self.middle[2] - 0.4 * self.size) - 0.15 * self.size

    @classmethod
    def of_start(cls, scene):
        """Return the space that a scene takes as far as its start tells."""
        points = [member.position for member in (*scene.bodies, *scene.anchors)]
        # Bodies swing to the other side of what they hang from.
        around = [np.array(anchor.position) + shift for anchor in scene.anchors
                  for body in scene.bodies
                  for shift in _swings(np.subtract(body.position, anchor.position))]
        return cls(scene, np.array([*points, *around], float))

    def draw(self, api, parent):
        """Draw the floor with the directions of the axes; return the light from above."""
        cell = _round(self.size / 8.0)
        width = cell * 2 * math.ceil(0.65 * self.size / cell)
        x, y, _ = self.middle
        origin = np.array([round(x / cell) * cell, round(y / cell) * cell, self.floor])
        api.add_grid(f'{parent}/floor', width=width, height=width, cell_size=cell,
                     section_size=5 * cell, position=origin, infinite_grid=self.is_left,
                     fade_distance=12 * self.size, cell_color=(205, 209, 214),
                     section_color=(160, 166, 173))
        # viser's own lights wash colours out.
        api.configure_default_lights(enabled=False)
        api.configure_environment_map(hdri=None)
        api.add_light_hemisphere('/sky', sky_color=(255, 255, 255), ground_color=(150, 150, 150),
                                 intensity=2.0)
        corner = origin - (0.5 * width, 0.5 * width, 0.0)
        length = 0.16 * self.size
        api.add_frame(f'{parent}/axes', axes_length=length, axes_radius=0.03 * length,
                      origin_radius=0.06 * length, position=corner)
        for i, name in enumerate('xyz'):
            api.add_label(f'{parent}/axes/{name}', name, anchor='center-center',
                          position=1.25 * length * np.eye(3)[i])
        return api.add_light_directional(
            '/sun', intensity=1.6, position=self.middle + self.size * np.array([0.7, -0.8, 2.0]))

    def viewpoint(self, aspect):
        """Return from where to look, and to where; aspect: width of the view over its height."""
        rise = _RISE if aspect < _SLIM else 0.0
        factor = min(max(1.0 / aspect, 1.0), _FARTHEST)
        target = self.middle - (0.0, 0.0, (0.08 + rise) * self.size)
        distance = 0.95 * factor * self.size / math.tan(0.5 * _FOV)
        direction = np.array([0.55, -0.78, 0.30])
        return target + distance * direction / np.linalg.norm(direction), target

    def look(self, camera, aspect=1.0):
        """Set where a viser camera begins."""
        camera.fov = _FOV
        camera.near, camera.far = 1e-3 * self.size, 300.0 * self.size
        camera.position, camera.look_at = self.viewpoint(aspect)


def _extent(body):
    """Return the widths of a body along its axes [m], () where it has none."""
    if isinstance(body, Sphere):
        return (2.0 * body.radius,) * 3
    return tuple(body.size) if isinstance(body, Box) else ()


def _swings(arm):
    """Return (5, 3) places around a point at which something may hang from it."""
    length = np.linalg.norm(arm)
    aside = max(np.hypot(arm[0], arm[1]), 0.35 * length)
    return np.array([[aside, 0, 0], [-aside, 0, 0], [0, aside, 0], [0, -aside, 0],
                     [0, 0, min(arm[2], 0.0)]])


def _round(length):
    """Return the length that is 1, 2 or 5 times a power of ten and nearest below."""
    power = 10.0 ** math.floor(math.log10(length))
    return max(factor for factor in (1, 2, 5) if factor * power <= length * 1.0001) * power
