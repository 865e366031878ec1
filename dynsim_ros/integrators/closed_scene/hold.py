# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The springs of a model one by one, and where their ends are."""

from typing import NamedTuple


class End(NamedTuple):
    """
    One end of a spring.

    body: its index, None at an anchor; offset: (3,) body-fixed [m]; position, velocity: (3,) of
    the anchor in world [m, m/s], None on a body.
    """

    body: int | None
    offset: tuple
    position: tuple | None
    velocity: tuple | None


class Hold(NamedTuple):
    """A spring between two Ends; SI units, damping 0 without a damper."""

    p: End
    q: End
    stiffness: float
    natural_length: float
    damping: float

    @property
    def anchor(self):
        """Return the End at an anchor, or None."""
        return next((end for end in (self.p, self.q) if end.body is None), None)

    @property
    def end(self):
        """Return the (first) End on a body."""
        return self.q if self.q.body is not None else self.p


def holds_of(model, anchors):
    """Return the Holds of a model."""
    holds = []
    for group in model.springs or ():
        for s, (stiffness, natural_length) in enumerate(zip(group.stiffness.tolist(),
                                                            group.natural_length.tolist())):
            damping = 0.0 if group.damping is None else float(group.damping[s])
            holds.append(Hold(_end(group.p, s, anchors), _end(group.q, s, anchors), stiffness,
                              natural_length, damping))
    return holds


def clusters(bodies, rigid, holds):
    """
    Yield (members, rigid, holds) for all bodies that springs connect with one another.

    members: their indices, ascending, so that rigid ones come first; rigid: how many those are;
    holds: with the place among the members instead of the index of a body.
    """
    chief = list(range(bodies))

    def chief_of(i):
        while chief[i] != i:
            chief[i] = i = chief[chief[i]]
        return i

    for hold in holds:
        if hold.p.body is not None and hold.q.body is not None:
            chief[chief_of(hold.p.body)] = chief_of(hold.q.body)
    members, held = {}, {}
    for i in range(bodies):
        members.setdefault(chief_of(i), []).append(i)
    for hold in holds:
        held.setdefault(chief_of(hold.end.body), []).append(hold)
    for number, indices in members.items():
        place = {index: i for i, index in enumerate(indices)}
        yield indices, len([i for i in indices if i < rigid]), [
            hold._replace(p=hold.p._replace(body=place.get(hold.p.body)),
                          q=hold.q._replace(body=place.get(hold.q.body)))
            for hold in held.get(number, ())]


def _end(ends, s, anchors):
    zero = (0.0, 0.0, 0.0)
    if ends.anchor is not None:
        row = anchors[ends.anchor[s]].tolist()
        return End(None, zero, tuple(row[:3]), tuple(row[3:]))
    if ends.particle is not None:
        return End(int(ends.particle[s]), zero, None, None)
    return End(int(ends.body[s]), tuple(ends.offset[s].tolist()), None, None)
