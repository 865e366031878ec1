# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which kernels a motion needs, told without compiling any."""

import numpy as np

from .closed_scene import Recogniser
from .methods import DEFAULT_METHOD
from .stepping import explicit_method
from ..physics.known import Known, KnownIndex
from ..physics.structure import with_structure


def kernel_kind(settings, model, drive, state):
    """
    Return something hashable: where it is the same, a motion begins with the same kernels.

    settings, model, drive: see new_steps; state: (size,) where it begins.
    """
    keeps_reaches = (settings.integrator in (DEFAULT_METHOD, 'extrapolation')
                     and explicit_method(model, settings.tolerance).keeps_reaches)
    kind = settings.integrator, _types(with_structure(model, keeps_reaches)), _types(drive)
    if settings.integrator != DEFAULT_METHOD:
        return kind
    # Without works, for which a kernel is called already to find out what is closed.
    closed = Recogniser(model, drive._replace(works=None)).closed_scene(state)
    return *kind, _types(closed)


def _types(value):
    """Return the types of a value and its parts, as far as numba tells them apart."""
    if isinstance(value, (Known, KnownIndex)):
        return type(value), value
    if isinstance(value, tuple):
        return type(value), *map(_types, value)
    if isinstance(value, np.ndarray):
        return value.dtype, value.ndim
    return type(value)
