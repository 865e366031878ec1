# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Springs as they are drawn: coils that stretch, coloured by their force."""

from __future__ import annotations

import numpy as np

from .shapes import coil, turn_of_z

# Compressed, without force, stretched.
COLORS = np.array([[37, 99, 235], [128, 134, 142], [214, 40, 40]], float)


class SpringView:
    """
    A spring. force: of the spring alone as shown [N], above 0 where it pulls.

    full_force: the force that has the full colour [N]; it grows with what is shown.
    """

    def __init__(self, api, name, spring, space):
        self._api, self._name, self._space = api, name, space
        self._spring = spring
        self._draw()
        self.full_force = 0.25 * spring.stiffness * (spring.natural_length or space.size)

    def set_spring(self, spring):
        """Draw the spring with other quantities."""
        is_longer = spring.natural_length != self._spring.natural_length
        self._spring = spring
        if is_longer:
            self._draw()

    def show(self, ends):
        """Draw it between two ends: {name: BodyView or AnchorView}."""
        spring = self._spring
        start = ends[spring.from_].attachment(spring.from_offset)
        along = ends[spring.to].attachment(spring.to_offset) - start
        length = max(float(np.linalg.norm(along)), 1e-6 * self._space.unit)
        self.force = spring.stiffness * (length - spring.natural_length)
        self.full_force = max(self.full_force, abs(self.force))
        self._mesh.position = start
        self._mesh.wxyz = turn_of_z(along / length)
        self._mesh.scale = (1.0, 1.0, length)
        self._mesh.color = color_of(self.force / self.full_force if self.full_force else 0.0)

    def _draw(self):
        unit = self._space.unit
        length = self._spring.natural_length or 0.2 * self._space.size
        self._mesh = self._api.add_mesh_simple(
            self._name, *coil(length, 0.28 * unit, 0.05 * unit), color=tuple(map(int, COLORS[1])))


def color_of(share):
    """Return the colour (r, g, b), 0 to 255, of a share of the full force, from -1 to 1."""
    rgb = [np.interp(share, (-1.0, 0.0, 1.0), channel) for channel in COLORS.T]
    # In steps that nobody sees, so that it is not sent again and again.
    return tuple(int(4 * round(value / 4)) for value in np.minimum(rgb, 252))
