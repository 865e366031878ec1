# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Seen at a glance: most motions of a single body on springs have no closed form."""

from .hold import holds_of
from ...physics.rotation import rotate
from ...physics.vector import add, cross, subtract

# Of velocity and distance: what moves across its spring by more is not rounding.
_FAR = 1e-6

# As formulas of numbers, without the way by which kernels find them.
_rotate, _cross, _add, _subtract = (f.py_func for f in (rotate, cross, add, subtract))


class Openness:
    """
    Tells where it needs no closer look that a motion has no closed form.

    model, drive: as for Recogniser, which takes the closer look.
    """

    def __init__(self, model, drive):
        self._anchors, self._offset = drive.anchors, None
        self._is_hung = model.springs is not None and model.several is None
        if not self._is_hung:
            return
        holds = holds_of(model, drive.anchors)
        self._is_hung = any(hold.natural_length or hold.damping or any(hold.end.offset)
                            for hold in holds)
        self._is_on_one = len(holds) == 1
        if self._is_on_one:
            group, = model.springs
            self._anchor = next(int(ends.anchor[0]) for ends in (group.p, group.q)
                                if ends.anchor is not None)
            self._offset = holds[0].end.offset if any(holds[0].end.offset) else None

    def is_plain(self, state):
        """Return whether a state (size,) moves so that there is plainly no closed form."""
        if not self._is_hung:
            return False
        *position, u, v, w = state[:6].tolist()
        if not self._is_on_one:
            return bool(u or v or w)
        px, py, pz, *velocity = self._anchors[self._anchor].tolist()
        velocity = _subtract((u, v, w), velocity)
        if self._offset is not None:
            position = _add(position, _rotate(tuple(state[6:10].tolist()), self._offset))
        direction = _subtract(position, (px, py, pz))
        across = max(map(abs, _cross(direction, velocity)))
        return across > _FAR * max(map(abs, direction)) * max(map(abs, velocity))
