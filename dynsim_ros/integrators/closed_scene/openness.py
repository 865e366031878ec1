# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Seen at a glance: most motions of a single body on springs have no closed form."""

from .hold import holds_of

# Of velocity and distance, squared: what moves across its spring by more is not rounding.
_FAR = 1e-12


class Openness:
    """
    Tells where it needs no closer look that a motion has no closed form.

    model, drive: as for Recogniser, which takes the closer look.
    """

    def __init__(self, model, drive):
        self._is_hung = model.springs is not None and model.several is None
        if not self._is_hung:
            return
        holds = holds_of(model, drive.anchors)
        self._is_hung = any(hold.natural_length or hold.damping or any(hold.end.offset)
                            for hold in holds)
        self._is_on_one = len(holds) == 1
        if self._is_on_one:
            group, = model.springs
            # A view: anchors are moved in place.
            self._anchor = next(drive.anchors[int(ends.anchor[0])]
                                for ends in (group.p, group.q) if ends.anchor is not None)
            x, y, z = holds[0].end.offset
            self._arm_square = x * x + y * y + z * z

    def is_plain(self, state):
        """Return whether a state (size,) moves so that there is plainly no closed form."""
        if not self._is_hung:
            return False
        x, y, z, u, v, w = state[:6].tolist()
        if not self._is_on_one:
            return bool(u or v or w)
        # Where all is along the line of a spring, so is the arm: the centre moves on that line.
        px, py, pz, pu, pv, pw = self._anchor.tolist()
        x, y, z, u, v, w = x - px, y - py, z - pz, u - pu, v - pv, w - pw
        a, b, c = y * w - z * v, z * u - x * w, x * v - y * u
        return (a * a + b * b + c * c
                > _FAR * (x * x + y * y + z * z + self._arm_square) * (u * u + v * v + w * w))
