# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Kernels for one structure: how many bodies there are, and which spring holds which of them.

A small scene's explicit kernels are compiled for its own structure. They take about a third less
time than those for any number of bodies and springs, and no longer to be compiled.
"""

import numpy as np

from .known import Known, KnownIndex
from .offset import AxisOffset

# Above these, kernels would be long, and nothing would be in registers anyway.
MOST_BODIES, MOST_SPRINGS = 4, 6


def with_structure(model):
    """Return a Model with its structure in its type, each spring its own group, if it is small."""
    bodies, springs = len(model.mass), model.connections or 1
    if bodies > MOST_BODIES or springs > MOST_SPRINGS or bodies == springs == 1:
        return model
    if model.springs is not None:
        model = model._replace(springs=tuple(
            _spring_of(group, s) for group in model.springs for s in range(len(group.stiffness))))
    if model.several is None:
        return model
    return model._replace(several=tuple(map(Known, model.several)),
                          round_body=_known(model.round_body),
                          general_body=_known(model.general_body))


def _spring_of(group, s):
    one = slice(s, s + 1)
    return group._replace(
        p=_end_of(group.p, one), q=_end_of(group.q, one), stiffness=group.stiffness[one],
        natural_length=group.natural_length[one], epsilon=group.epsilon[one],
        damping=None if group.damping is None else group.damping[one])


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
