# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The reach of a spring beside the state: the vector r from its anchor to where it holds the body.

As a sum of positions in world it has their rounding, which a stiff spring turns into forces. Here
it is known to twice the digits at the start of a step, and its change d since then is a small
number with a small rounding. So are L^2 - L_n^2, which changes by d . (2 r + d), and with it the
extension L - L_n. It is kept where arms are, to whose ends it goes: see there.
"""

from typing import NamedTuple


from .arms import is_none, kept_end, Types
from .fused import fused
from .jit import formula, overload
from .state import ARM, CORRECTION, EXCESS, REACH, VECTOR
from .two_sum import two_sum
from .vector import add, at, put, scale


class Reach(NamedTuple):
    """
    The reach at the start of a step, of numbers or Lanes.

    vector: (3,) [m]; moving: as in Drive; velocity: (3,) of the anchor [m/s]; excess: L^2 - L_n^2
    [m^2]; correction: about 1 / (L + L_n) [1/m], where L is not far from L_n.
    """

    vector: tuple
    moving: bool | None
    velocity: tuple
    excess: float
    correction: float


@formula
def add_in_two(sums, left, b):
    """Return the vector sums + b as rounded, and the vector left with what rounding left out."""
    x, i = two_sum(sums[0], b[0])
    y, j = two_sum(sums[1], b[1])
    z, k = two_sum(sums[2], b[2])
    return (x, y, z), add(left, (i, j, k))


@formula
def anchor_way(t, velocity):
    """Return how far an anchor has moved since time 0, negative, as the sum of two vectors."""
    u, v, w = scale(-1.0, velocity)
    x, y, z = t * u, t * v, t * w
    return (x, y, z), (fused(t, u, -x), fused(t, v, -y), fused(t, w, -z))


@formula
def difference_of_squares(r, left, natural_length):
    """Return |r + left|^2 - L_n^2, exact also where the two are nearly the same."""
    square = natural_length * natural_length
    total, rest = -square, -fused(natural_length, natural_length, -square)
    for i in range(3):
        square = r[i] * r[i]
        total, more = two_sum(total, square)
        rest = rest + (more + fused(r[i], r[i], -square)) + (2.0 * r[i]) * left[i]
    return total + rest


@formula
def correction_of(excess, natural_length, epsilon):
    """Return about 1 / (L + L_n), where L is not far from L_n; of a spring."""
    square = natural_length * natural_length
    return natural_length / (excess + 2.0 * square + epsilon * epsilon)


@formula
def with_way(moving, velocity, t, r, left):
    """Return r, in two vectors, less the way of the anchor."""
    if moving is not None:
        way, rest = anchor_way(t, velocity)
        r, left = add_in_two(r, left, way)
        left = add(left, rest)
    return r, left


@formula
def reach_from(anchor, natural_length, epsilon, anchors, moving, t, y, arm):
    """Return the Reach in a state; anchor, natural_length, epsilon: of a SpringGroup of one."""
    place, velocity = at(anchors[anchor[0]], 0), at(anchors[anchor[0]], 3)
    r, left = add_in_two(at(y, 0), (0.0, 0.0, 0.0), scale(-1.0, place))
    r, left = add_in_two(r, left, arm)
    r, left = with_way(moving, velocity, t, r, left)
    natural, least = natural_length[0], epsilon[0]
    excess = difference_of_squares(r, left, natural)
    return Reach(r, moving, velocity, excess, correction_of(excess, natural, least))


def reach_of_state(model, drive, t, y, arm):
    """Return the Reach in a state of numbers or Lanes, with its arm; None where none is kept."""
    end = kept_end(model, lambda part: part is None)
    if end is None:
        return None
    group = model.springs[0]
    return reach_from(group[1 - end].anchor, group.natural_length, group.epsilon, drive.anchors,
                      drive.moving, t, y, arm)


@overload(reach_of_state)
def _reach_of_state(model, drive, t, y, arm):
    end = kept_end(Types(model), is_none)
    if end is None:
        return lambda model, drive, t, y, arm: None
    other = 1 - end

    def found(model, drive, t, y, arm):
        group = model.springs[0]
        return reach_from(group[other].anchor, group.natural_length, group.epsilon, drive.anchors,
                          drive.moving, t, y, arm)
    return found


@formula
def less_anchor_way(moving, velocity, way, d):
    """Return d less how far the anchor has moved since the start; way: time since then [s]."""
    if moving is not None:
        return (fused(-way, velocity[0], d[0]), fused(-way, velocity[1], d[1]),
                fused(-way, velocity[2], d[2]))
    return d


@formula
def put_reach(reach, way, here, state):
    """Write to a state what is kept of its reach; here: the state less that at the start."""
    if reach is not None:
        d = less_anchor_way(reach.moving, reach.velocity, way, add(at(here, 0), at(here, ARM)))
        put_moved(reach.vector, reach.excess, reach.correction, d, REACH, state)


@formula
def put_moved(vector, excess, correction, d, place, state):
    """Write a reach (3,) that has changed by d, its excess and its correction to a state."""
    r = add(vector, d)
    put(state, place + VECTOR, r)
    x, y, z = add(vector, r)
    state[place + EXCESS] = fused(d[0], x, fused(d[1], y, fused(d[2], z, excess)))
    state[place + CORRECTION] = correction
