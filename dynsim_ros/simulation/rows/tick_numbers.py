# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""All numbers of one instant of a run in one array, and where each of them stands."""

from typing import NamedTuple

import numpy as np

# Kinds of wrench, then their sum with what is commanded.
KINDS = ('spring', 'damper', 'air', 'gravity', 'net')
ENERGIES = ('kinetic', 'gravitational', 'spring', 'total', 'work_damper', 'work_air',
            'work_anchor', 'work_push', 'imbalance')


class NumberArrays(NamedTuple):
    """
    The numbers as the kernel writes them; the others are parts of `values`.

    forces: (5, size), rows KINDS, each laid out as the state; anchors: (n, 6) as in Drive;
    energies: (9,) ENERGIES [J].
    """

    values: np.ndarray
    forces: np.ndarray
    anchors: np.ndarray
    energies: np.ndarray


class Numbers:
    """Where the numbers of a scene stand in `values`; layout: Layout. All in world axes, SI."""

    def __init__(self, layout):
        self._layout = layout
        self._forces = layout.size
        self._anchors = self._forces + len(KINDS) * layout.size
        self._energies = self._anchors + 6 * len(layout.anchors)
        self.size = self._energies + len(ENERGIES)

    def arrays(self):
        """Return new NumberArrays, zero."""
        values = np.zeros(self.size)
        return NumberArrays(
            values, values[self._forces:self._anchors].reshape(len(KINDS), self._forces),
            values[self._anchors:self._energies].reshape(-1, 6), values[self._energies:])

    def position(self, body):
        """Return the three places of a body's position."""
        return _places(self._layout.position(body))

    def velocity(self, body):
        """Return the three places of a body's velocity."""
        return _places(self._layout.velocity(body))

    def orientation(self, body):
        """Return the four places of a rigid body's (w, x, y, z), None for a particle."""
        return _places(self._layout.orientation(body))

    def angular_velocity(self, body):
        """Return the three places of a rigid body's angular velocity, None for a particle."""
        return _places(self._layout.angular_velocity(body))

    def force(self, kind, body):
        """Return the three places of a force on a body; kind: one of KINDS."""
        return _places(self._layout.velocity(body), self._row(kind))

    def torque(self, kind, body):
        """Return the three places of a torque on a rigid body, None for a particle."""
        return _places(self._layout.angular_velocity(body), self._row(kind))

    def anchor_position(self, anchor):
        """Return the three places of an anchor's position."""
        start = self._anchors + 6 * self._layout.anchors.index(anchor)
        return range(start, start + 3)

    def energy(self, name):
        """Return the place of one of ENERGIES."""
        return self._energies + ENERGIES.index(name)

    def is_force(self, place):
        """Tell whether at a place there is a force or torque."""
        return self._forces <= place < self._anchors

    def is_energy(self, place):
        """Tell whether at a place there is one of ENERGIES."""
        return self._energies <= place

    def _row(self, kind):
        return self._forces + KINDS.index(kind) * self._layout.size


def _places(part, start=0):
    """Return a slice of the state, or of what is laid out as it and begins at start, as places."""
    return None if part is None else range(start + part.start, start + part.stop)
