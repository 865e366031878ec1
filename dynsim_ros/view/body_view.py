# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bodies and anchors as they are drawn."""

from __future__ import annotations

import numpy as np
from viser.transforms import SO3

from .shapes import ellipsoid, octants
from ..scene import Box, Rigid, RigidBody, Sphere

# The two colours of a body: bodies take them in turn.
_COLORS = (((223, 233, 247), (46, 105, 190)), ((250, 232, 213), (193, 98, 28)),
           ((222, 240, 224), (40, 125, 62)), ((235, 226, 246), (112, 72, 166)))
_ANCHOR = (201, 52, 43)
_UPRIGHT = (1.0, 0.0, 0.0, 0.0)


class BodyView:
    """
    A body, marked so that its turning shows, with its own axes if it has any.

    position: (3,) of the centre of mass as shown [m]; rotation: SO3, body to world; turns: whether
    it has an orientation; meshes: what can be grabbed.
    """

    def __init__(self, api, name, body, space, number):
        self._space = space
        size, _ = self._look(body)
        self.turns = isinstance(body, Rigid)
        self._frame = api.add_frame(
            name, show_axes=self.turns, axes_length=1.35 * max(size),
            axes_radius=0.045 * max(size), origin_radius=0.01 * max(size))
        light, dark = _COLORS[number % len(_COLORS)]
        self.meshes = [
            api.add_mesh_simple(f'{name}/{part}', *octants(isinstance(body, Box), part == 'dark'),
                                color=color if self.turns else dark)
            for part, color in (('light', light), ('dark', dark))]
        self.label = api.add_label(f'{name}/name', body.name, anchor='bottom-left',
                                   position=(0.0, 0.0, 0.0), font_screen_scale=0.9)
        self.set_body(body)
        quaternion = getattr(body, 'orientation', _UPRIGHT)
        self.show(np.array([*body.position, *quaternion[1:], quaternion[0]]))

    def set_body(self, body):
        """Draw the body with other quantities."""
        self.body = body
        size, turn = self._look(body)
        for mesh in self.meshes:
            mesh.scale = tuple(map(float, size))
            mesh.wxyz = turn
        self._frame.axes_length = float(1.35 * max(size))

    def show(self, row):
        """Draw it where a message says: (7,) position [m] and quaternion (x, y, z, w)."""
        x, y, z, w = row[3:7]
        self.position, quaternion = row[:3], np.array([w, x, y, z])
        self.rotation = SO3(quaternion)
        self._frame.position = self.position
        self._frame.wxyz = quaternion

    def attachment(self, offset):
        """Return where a spring is attached, (3,) [m]: offset: (3,) body-fixed [m], or None."""
        if not self.turns:
            return self.position
        offset = self.body.default_offset if offset is None else offset
        return self.position + self.rotation.apply(np.array(offset))

    def _look(self, body):
        """Return half-widths [m] and the quaternion (w, x, y, z) by which they are turned."""
        if isinstance(body, Sphere):
            return (body.radius,) * 3, _UPRIGHT
        if isinstance(body, Box):
            return tuple(0.5 * np.array(body.size)), _UPRIGHT
        if isinstance(body, RigidBody):
            half, axes = ellipsoid(body)
            return half, SO3.from_matrix(axes).wxyz
        return (0.35 * self._space.unit,) * 3, _UPRIGHT


class AnchorView:
    """An anchor: a small cube. position: (3,) as shown [m]."""

    def __init__(self, api, name, anchor, space):
        # Its faces share no vertices: flat also as other meshes are shaded, which browsers have a
        # program for already; another takes 0.1 s where there is no graphics card.
        self._cube = api.add_box(name, color=_ANCHOR, dimensions=(0.35 * space.unit,) * 3,
                                 flat_shading=False)
        self.label = api.add_label(f'{name}/name', anchor.name, anchor='bottom-left',
                                   position=(0.0, 0.0, 0.3 * space.unit), font_screen_scale=0.9)
        self.show(np.array(anchor.position))

    def show(self, row):
        """Draw it where a message says: (3 or more,) position [m]."""
        self.position = row[:3]
        self._cube.position = self.position

    def attachment(self, _):
        """Return where a spring is attached: (3,) [m]."""
        return self.position
