# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Whether everything is at rest and stays so.

It does if no force and no moment is left, to the last bit; then the equilibrium may be unstable,
as a motion that is integrated would not leave it either. If only rounding is left, every body
must be pulled back by springs: the second derivatives of their energy with respect to small
displacements and turns have no negative eigenvalue.

Source: Goldstein, Poole and Safko, Classical Mechanics (2002), section 6.1.
"""

import math

import numpy as np

from .hold import clusters, holds_of
from .imbalance import is_unbalanced
from ..closed_form import cancels, spring_size
from ...physics import motion, rotation, vector
from ...physics.fused import EXACTLY, QUICKLY
from ...physics.jit import plain

_apply_forces = plain(motion.apply_forces, **EXACTLY)
_add, _dot, _norm, _rotate, _scale, _subtract = (plain(each, **QUICKLY) for each in (
    vector.add, vector.dot, vector.norm, rotation.rotate, vector.scale, vector.subtract))
# An eigenvalue that is above minus this, relative to the stiffnesses, counts as not negative: in
# an hour nothing visible comes of rounding there.
_NEUTRAL = 1e-9
# A part of forces that is so small beside them is left of them by rounding.
_HARDLY = 0.01
# So many bodies that springs connect are not held: to find out whether they may be takes too long.
_MANY = 100
_EYE = np.eye(3)


class _Body:
    """A body at rest, with the size of the terms of the sums of forces and moments."""

    def __init__(self, position, orientation):
        self.position, self.orientation = position, orientation
        self.force_size = self.moment_size = 0.0

    def arm(self, offset):
        """Return the vector from the centre of mass to an attachment point, in world: (3,)."""
        return _rotate(self.orientation, offset) if any(offset) else offset


def moves(model, state):
    """Return whether anything moves in a state."""
    bodies = len(model.mass)
    return (any(state[3 * bodies:6 * bodies].tolist())
            or any(state[6 * bodies + 4 * model.rigid:6 * bodies + 7 * model.rigid].tolist()))


def is_equilibrium(model, drive, start, holds):
    """Return whether the state `start`, in which nothing moves, lasts; holds: from holds_of."""
    if any(hold.anchor is not None and any(hold.anchor.velocity) for hold in holds):
        return False
    if is_unbalanced(model, drive, start, holds):
        return False
    left = _left(model, drive, start)
    return not left.any() or _is_rounding(model, drive, start, holds, left.tolist())


def comes_to_rest(model, drive, state, longest, near):
    """
    Return whether what still moves in a state (size,) is to come to rest next to where it is.

    It is where the place is stable, the air stops each body within `longest` [s], and what is left
    of forces pulls none farther than `near` [m, rad] until springs balance it: strong drag may
    make a motion slow that is to go far.
    """
    holds = holds_of(model, drive.anchors)
    if any(hold.anchor is not None and any(hold.anchor.velocity) for hold in holds):
        return False
    if _is_turned(model, drive) or not _is_stopped(model, longest):
        return False
    things, left = _bodies(model, state), _left(model, drive, state)
    for members, rigid, held in clusters(len(things), model.rigid, holds):
        if len(members) > _MANY:
            return False
        rows = [*members, *(len(things) + i for i in members[:rigid])]
        if not _is_near(rigid, held, [things[i] for i in members], left[rows].ravel(), near):
            return False
    return True


def _is_near(rigid, holds, things, left, near):
    """Return whether forces and moments that are left, (n,), pull nothing farther than `near`."""
    factor, scaling = _factored_curvature(rigid, holds, things)
    if factor is None:
        return False
    left = scaling * left
    # The part of it to which springs do not answer, as far as they should be told apart.
    unanswered = _NEUTRAL * _solved(factor, left)
    if abs(unanswered).max() > _HARDLY * abs(left).max():
        return False
    return abs(scaling * _solved(factor, left - unanswered)).max() <= near


def _left(model, drive, state):
    """Return (n, 3) what is left of forces, then of moments, on all bodies if nothing moved."""
    bodies, rigid = len(model.mass), model.rigid
    torque_at = 6 * bodies + 4 * rigid
    still, left = state.tolist(), [0.0] * len(state)
    still[3 * bodies:6 * bodies] = [0.0] * (3 * bodies)
    still[torque_at:torque_at + 3 * rigid] = [0.0] * (3 * rigid)
    _apply_forces(model, drive._replace(works=None), 0.0, still, left)
    return np.array(left[3 * bodies:6 * bodies]
                    + left[torque_at:torque_at + 3 * rigid]).reshape(-1, 3)


def _is_stopped(model, longest):
    """Return whether the air alone stops each body within a time [s]."""
    air = model.air
    if air is None or air.linear_drag is None:
        return False
    if max(model.mass) > longest * air.linear_drag:
        return False
    if model.rigid == 0:
        return True
    inertias = [] if model.round_inertia is None else [max(model.round_inertia)]
    if model.inertia is not None:
        # No moment of inertia is larger than the trace.
        inertias.append(max(matrix.trace() for matrix in model.inertia))
    return air.rotational_drag is not None and max(inertias) <= longest * air.rotational_drag


def _is_turned(model, drive):
    """Return whether a torque is commanded, or the air whirls."""
    torque_at = 6 * len(model.mass) + 4 * model.rigid
    if drive.pushes is not None and drive.pushes[torque_at:].any():
        return True
    return model.air is not None and model.air.angular_velocity is not None


def _bodies(model, start):
    bodies = len(model.mass)
    return [_Body(tuple(start[3 * i:3 * i + 3].tolist()),
                  tuple(start[6 * bodies + 4 * i:6 * bodies + 4 * i + 4].tolist()))
            for i in range(bodies)]


def _is_rounding(model, drive, start, holds, left):
    """Return whether what is left, a list as of _left, is rounding, in a stable place."""
    if _is_turned(model, drive):
        return False
    things = _bodies(model, start)
    _add_sizes(model, drive, holds, things)
    sizes = ([thing.force_size for thing in things]
             + [thing.moment_size for thing in things[:model.rigid]])
    return (all(cancels(tuple(total), size) for total, size in zip(left, sizes))
            and _is_stable(model.rigid, holds, things))


def _add_sizes(model, drive, holds, things):
    drag, wind = 0.0, (0.0, 0.0, 0.0)
    if model.air is not None and model.air.linear_drag is not None:
        drag, wind = model.air.linear_drag, model.air.velocity or (0.0, 0.0, 0.0)
    for i, thing in enumerate(things):
        thing.force_size = drag * _norm(tuple(wind))
        for rows in (model.weight, None if drive.pushes is None
                     else drive.pushes[3 * len(things):6 * len(things)].reshape(-1, 3)):
            if rows is not None:
                thing.force_size += _norm(tuple(rows[i].tolist()))
    for hold in holds:
        size = spring_size(hold.stiffness, hold.natural_length, _place(hold.p, things),
                           _place(hold.q, things))
        for end in (hold.p, hold.q):
            if end.body is not None:
                things[end.body].force_size += size
                things[end.body].moment_size += size * _norm(end.offset)


def _place(end, things):
    if end.body is None:
        return end.position
    thing = things[end.body]
    return _add(thing.position, thing.arm(end.offset))


def _is_stable(rigid, holds, things):
    """Return whether no small displacement or turn sets energy free."""
    if rigid == 0 and all(_stretch(hold, things) >= 0.0 for hold in holds):
        # Springs that pull do not let particles go anywhere.
        return True
    return all(
        _factored_curvature(turning, held, [things[i] for i in members])[0] is not None
        for members, turning, held in clusters(len(things), rigid, holds))


def _factored_curvature(rigid, holds, things):
    """
    Return the second derivatives of springs' energy, in scaled displacements, and the scales.

    The former as _factor returns them, with what counts as not negative made positive, the latter
    (n,); None and None where there are no derivatives.
    """
    size = 3 * (len(things) + rigid)
    curvature, largest = np.zeros((size, size)), np.zeros(size)
    for hold in holds:
        more = _curvature(hold, rigid, things, size)
        if more is None:
            return None, None
        curvature += more
        largest += abs(more).diagonal()
    # one scale for all directions: in one that is neutral there is nothing but rounding
    largest = largest.reshape(-1, 3).max(axis=1).repeat(3)
    largest[largest == 0.0] = 1.0
    scaling = 1.0 / np.sqrt(largest)
    return _factor(curvature * scaling * scaling[:, np.newaxis]
                   + _NEUTRAL * np.eye(size)), scaling


def _way(hold, things):
    """Return the vector to Q from P: (3,) [m]."""
    return _subtract(_place(hold.q, things), _place(hold.p, things))


def _stretch(hold, things):
    """Return by how much a spring is longer than its natural length [m]."""
    return _norm(_way(hold, things)) - hold.natural_length


def _curvature(hold, rigid, things, size):
    """Return the second derivatives of a spring's energy; None where there are none."""
    r = _way(hold, things)
    length = _norm(r)
    if length == 0.0 and hold.natural_length > 0.0:
        return None
    u = _scale(1.0 / length, r) if length > 0.0 else r
    pull = hold.stiffness * (length - hold.natural_length)
    across = pull / length if length > 0.0 else hold.stiffness
    # how each component of the way of Q from P depends on displacements and turns
    way, more = np.zeros((3, size)), np.zeros((size, size))
    for end, sign in ((hold.p, -1.0), (hold.q, 1.0)):
        if end.body is None:
            continue
        way[:, 3 * end.body:3 * end.body + 3] += sign * _EYE
        if end.body < rigid:
            a = things[end.body].arm(end.offset)
            turn = slice(3 * (len(things) + end.body), 3 * (len(things) + end.body) + 3)
            way[:, turn] += sign * np.array([[0, a[2], -a[1]], [-a[2], 0, a[0]], [a[1], -a[0], 0]])
            bend = np.outer(u, a)
            more[turn, turn] += sign * pull * (0.5 * (bend + bend.T) - _dot(u, a) * _EYE)
    along = np.outer(u, u)
    stiffness = hold.stiffness * along + across * (_EYE - along)
    # not by a library's product: those differ in the last bits from machine to machine
    for i in range(3):
        pulled = stiffness[i, 0] * way[0] + stiffness[i, 1] * way[1] + stiffness[i, 2] * way[2]
        more += way[i, :, np.newaxis] * pulled
    return more


def _factor(matrix):
    """
    Return the upper triangle of a symmetric matrix by Cholesky's method; below it lies nothing.

    None where an eigenvalue is not positive. Not by a library, as its last bits differ.
    """
    factor = matrix.copy()
    for i in range(len(factor)):
        pivot = factor[i, i]
        if not pivot > 0.0:
            return None
        factor[i, i:] /= math.sqrt(pivot)
        row = factor[i, i + 1:]
        factor[i + 1:, i + 1:] -= np.outer(row, row)
    return factor


def _solved(factor, right):
    """Return the solution of linear equations with a matrix of which _factor is known: (n,)."""
    x = right.copy()
    for i in range(len(x)):
        x[i] /= factor[i, i]
        x[i + 1:] -= factor[i, i + 1:] * x[i]
    for i in reversed(range(len(x))):
        x[i] /= factor[i, i]
        x[:i] -= factor[:i, i] * x[i]
    return x
