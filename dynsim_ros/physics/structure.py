# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Kernels for one structure: how many bodies there are, and which spring holds which of them.

A small scene's explicit kernels are compiled for its own structure. They take about a third less
time than those for any number of bodies and springs, and no longer to be compiled, but where they
keep reaches.
"""

import numpy as np

from .known import Known, KnownIndex
from .offset import AxisOffset
from .state import REACH_SIZE, state_size

# Above these, kernels would be long, and nothing would be in registers anyway.
MOST_BODIES, MOST_SPRINGS = 4, 6


def is_small(model):
    """Return whether a Model is small enough for kernels of its own."""
    return len(model.mass) <= MOST_BODIES and (model.connections or 1) <= MOST_SPRINGS


def with_structure(model, keeps_reaches=False):
    """
    Return a Model with its structure in its type, each spring its own group, if it is small.

    keeps_reaches: whether the reaches of springs between several bodies have places, see reaches.
    """
    if not is_small(model) or len(model.mass) == (model.connections or 1) == 1:
        return model
    if model.springs is not None:
        singles = [(group, s) for group in model.springs for s in range(len(group.stiffness))]
        has_place = keeps_reaches and model.several is not None
        model = model._replace(springs=tuple(
            _spring_of(group, s, _reach_at(model, i) if has_place else None)
            for i, (group, s) in enumerate(singles)))
    if model.several is None:
        return model
    return model._replace(several=tuple(map(Known, model.several)),
                          round_body=_known(model.round_body),
                          general_body=_known(model.general_body))


def _reach_at(model, spring):
    return Known(state_size(len(model.mass), model.rigid) + REACH_SIZE * spring)


def _spring_of(group, s, reach_at):
    one = slice(s, s + 1)
    return group._replace(
        p=_end_of(group.p, one), q=_end_of(group.q, one), stiffness=group.stiffness[one],
        natural_length=group.natural_length[one], epsilon=group.epsilon[one],
        damping=None if group.damping is None else group.damping[one], reach_at=reach_at)


def _end_of(ends, one):
    anchor, particle, body = (None if index is None else _known(index[one])
                              for index in (ends.anchor, ends.particle, ends.body))
    return ends._replace(anchor=anchor, particle=particle, body=body,
                         offset=None if ends.offset is None else _offset_of(ends.offset[one]))


def _offset_of(offset):
    axes = np.flatnonzero(offset)
    if len(axes) > 1:
        return offset
    # The centre is on every axis.
    axis = Known(axes[0] if len(axes) else 2)
    return AxisOffset(axis, offset[:, axis].copy())


def _known(index):
    return None if index is None else KnownIndex(index.tolist())
