# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Seen at a glance: bodies on which forces plainly do not cancel do not stay at rest."""

from .translations import drag_and_wind, forces
from ..closed_form import spring_size
from ...physics import rotation, vector
from ...physics.fused import QUICKLY
from ...physics.jit import plain

_add, _norm, _rotate, _scale, _subtract = (plain(each, **QUICKLY) for each in (
    vector.add, vector.norm, rotation.rotate, vector.scale, vector.subtract))
# Of the sizes of its terms: a sum that is larger is no rounding.
_PLAIN = 1e-9


def is_unbalanced(model, drive, start, holds):
    """
    Return whether a force is plainly left on a body of a state (size,) in which nothing moves.

    holds: from holds_of, of anchors that do not move.
    """
    drag, wind = drag_and_wind(model)
    blown = _scale(drag, wind) if drag else (0.0, 0.0, 0.0)
    for i, force in enumerate(forces(model, drive).tolist()):
        total, size = _add(force, blown), _norm(force) + _norm(blown)
        for hold in holds:
            for end, other in ((hold.p, hold.q), (hold.q, hold.p)):
                if end.body == i:
                    r_end, r_other = _place(model, start, end), _place(model, start, other)
                    total = _add(total, _pull(hold, _subtract(r_other, r_end)))
                    size += spring_size(hold.stiffness, hold.natural_length, r_end, r_other)
        if _norm(total) > _PLAIN * size:
            return True
    return False


def _place(model, start, end):
    """Return where an end of a spring is: (3,) [m]."""
    if end.body is None:
        return end.position
    centre = start[3 * end.body:3 * end.body + 3].tolist()
    if not any(end.offset):
        return centre
    at = 6 * len(model.mass) + 4 * end.body
    return _add(centre, _rotate(start[at:at + 4].tolist(), end.offset))


def _pull(hold, way):
    """Return the force on the end of a spring from which `way` leads to the other: (3,) [N]."""
    length = _norm(way)
    if length == 0.0:
        return way
    return _scale(hold.stiffness * (length - hold.natural_length) / length, way)
