# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The reaches of several springs beside the state: what reach is for a single one.

Bodies that hang on each other pass on what is rounded. Where small tolerances are asked for, and
the structure of a scene is known when kernels are compiled, each spring is a group of its own that
has a place behind the state: see structure.
"""

from typing import NamedTuple


from .arms import is_none, Types, with_springs
from .each import each
from .forces import arm_of
from .jit import formula, overload
from .model import SpringGroup
from .reach import add_in_two, correction_of, difference_of_squares, put_moved, with_way
from .state import counts
from .vector import add, at, scale, subtract


class SpringReach(NamedTuple):
    """
    The reach of a spring at the start of a step: as in Reach, of Q from P.

    p_arm, q_arm: (3,) of its ends then, zero at points [m].
    """

    vector: tuple
    excess: float
    correction: float
    p_arm: tuple
    q_arm: tuple


@formula
def with_end(bodies, sign, anchor, particle, body, offset, anchors, moving, t, y, r, left):
    """Return r and left with the place of the end of a spring, times 1 or -1, and its arm."""
    arm = (0.0, 0.0, 0.0)
    if anchor is not None:
        r, left = add_in_two(r, left, scale(sign, at(anchors[anchor[0]], 0)))
        r, left = with_way(moving, scale(-sign, at(anchors[anchor[0]], 3)), t, r, left)
    if particle is not None:
        r, left = add_in_two(r, left, scale(sign, at(y, 3 * particle[0])))
    if body is not None:
        arm = arm_of(bodies, body[0], offset, 0, y)
        r, left = add_in_two(r, left, scale(sign, at(y, 3 * body[0])))
        r, left = add_in_two(r, left, scale(sign, arm))
    return r, left, arm


@formula
def spring_reach(bodies, group, anchors, moving, t, y):
    """Return the SpringReach of a group of one spring in a state of numbers or Lanes."""
    p, q, zero = group.p, group.q, (0.0, 0.0, 0.0)
    r, left = zero, zero
    r, left, q_arm = with_end(bodies, 1.0, q.anchor, q.particle, q.body, q.offset, anchors, moving,
                              t, y, r, left)
    r, left, p_arm = with_end(bodies, -1.0, p.anchor, p.particle, p.body, p.offset, anchors,
                              moving, t, y, r, left)
    # What is left is of the places of the ends, not of what is between them.
    r, left = add_in_two(r, zero, left)
    natural = group.natural_length[0]
    excess = difference_of_squares(r, left, natural)
    return SpringReach(r, excess, correction_of(excess, natural, group.epsilon[0]), p_arm, q_arm)


@formula
def anchor_moves(moving, velocity, way):
    """Return how far an anchor has moved in a time `way`: (3,) [m]."""
    if moving is not None:
        return scale(way, velocity)
    return (0.0, 0.0, 0.0)


@formula
def end_way(bodies, anchor, particle, body, offset, arm, anchors, moving, way, here, state):
    """Return how far an end has come since the start of the step; arm: its arm then."""
    if anchor is not None:
        return anchor_moves(moving, at(anchors[anchor[0]], 3), way)
    if particle is not None:
        return at(here, 3 * particle[0])
    if body is not None:
        turned = subtract(arm_of(bodies, body[0], offset, 0, state), arm)
        return add(at(here, 3 * body[0]), turned)
    return (0.0, 0.0, 0.0)


@formula
def put_spring_reach(bodies, group, reach, anchors, moving, way, here, state):
    """Write to a state what is kept of the reach of a group of one spring; as put_reach."""
    p, q = group.p, group.q
    q_way = end_way(bodies, q.anchor, q.particle, q.body, q.offset, reach.q_arm, anchors, moving,
                    way, here, state)
    p_way = end_way(bodies, p.anchor, p.particle, p.body, p.offset, reach.p_arm, anchors, moving,
                    way, here, state)
    put_moved(reach.vector, reach.excess, reach.correction, subtract(q_way, p_way),
              group.reach_at, state)


@formula
def kept(group):
    """Return a SpringGroup whose reach is found in the state."""
    return SpringGroup(group.p, group.q, group.stiffness, group.natural_length, group.epsilon,
                       group.damping, group.reach_at, True)


def kept_groups(springs):
    """Return some SpringGroups as `kept` has them."""
    return tuple(map(kept, springs))


@overload(kept_groups)
def _kept_groups(springs):
    return each(kept_groups, 'kept(springs[{i}])', len(springs))


def spring_reaches(bodies, springs, anchors, moving, t, y):
    """Return the SpringReach of each of some SpringGroups."""
    return tuple(spring_reach(bodies, group, anchors, moving, t, y) for group in springs)


@overload(spring_reaches)
def _spring_reaches(bodies, springs, anchors, moving, t, y):
    return each(spring_reaches, 'spring_reach(bodies, springs[{i}], anchors, moving, t, y)',
                len(springs))


def put_spring_reaches(bodies, springs, reaches, anchors, moving, way, here, state):
    """Write what is kept of the reaches of some SpringGroups."""
    for group, reach in zip(springs, reaches):
        put_spring_reach(bodies, group, reach, anchors, moving, way, here, state)


@overload(put_spring_reaches)
def _put_spring_reaches(bodies, springs, reaches, anchors, moving, way, here, state):
    return each(put_spring_reaches, 'put_spring_reach(bodies, springs[{i}], reaches[{i}], '
                'anchors, moving, way, here, state)', len(springs))


def _are_kept(model):
    return bool(model.springs) and all(group.reach_at is not None for group in model.springs)


def _types_are_kept(model):
    springs = Types(model).springs
    return isinstance(springs, Types) and not any(is_none(group.reach_at) for group in springs)


def with_reaches(model):
    """Return the Model for states with the reaches of its springs; itself where none are kept."""
    return with_springs(model, kept_groups(model.springs)) if _are_kept(model) else model


@overload(with_reaches)
def _with_reaches(model):
    if _types_are_kept(model):
        return lambda model: with_springs(model, kept_groups(model.springs))
    return lambda model: model


@formula
def reaches_of_all(model, drive, t, y):
    """Return the reaches in a state of a model that keeps them."""
    bodies, _ = counts(model)
    return spring_reaches(bodies, model.springs, drive.anchors, drive.moving, t, y)


def reaches_of_state(model, drive, t, y):
    """Return the SpringReach of each spring in a state, None where they are not kept."""
    return reaches_of_all(model, drive, t, y) if _are_kept(model) else None


@overload(reaches_of_state)
def _reaches_of_state(model, drive, t, y):
    if _types_are_kept(model):
        return lambda model, drive, t, y: reaches_of_all(model, drive, t, y)
    return lambda model, drive, t, y: None


@formula
def put_reaches(model, drive, reaches, way, here, state):
    """Write to a state what is kept of its reaches; here: the state less that at the start."""
    if reaches is not None:
        bodies, _ = counts(model)
        put_spring_reaches(bodies, model.springs, reaches, drive.anchors, drive.moving, way, here,
                           state)
