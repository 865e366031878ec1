# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which rotations have a closed form when no spring exerts a moment, and their constants."""

import numpy as np

from .motion import Slowed, Spins, Tops, Whirls
from .rotation import rotations_of
from .tops import TOP_SIZE
from ..closed_form import principal_axes
from ..closed_form.whirl import TERMS


def rotations(model, drive, start, axes):
    """
    Return {'spins', 'slowed', 'whirls', 'tops'}, as in ClosedScene, or None.

    None: a rotation has no closed form. Nothing rotates: {}. start: the state, its quaternions
    normalised; axes: from all_axes.
    """
    if model.rigid == 0:
        return {}
    found = rotations_of(model, drive, start)
    spinning, whirled, free = {}, {}, []
    if model.round_body is not None:
        for i, inertia in zip(model.round_body.tolist(), model.round_inertia.tolist()):
            if found[i].keeps_axis:
                spinning[i] = inertia
            elif found[i].is_soon_stopped(inertia):
                whirled[i] = inertia
            else:
                return None
    if model.general_body is not None:
        for k, i in enumerate(model.general_body.tolist()):
            if found[i].is_free:
                free.append(k)
            elif (inertia := found[i].inertia_about_axis(model.inertia[k].tolist())) is not None:
                spinning[i] = inertia
            else:
                return None
    resisted = model.air is not None and bool(model.air.rotational_drag)
    return {'spins': None if resisted else _spins(found, spinning),
            'slowed': _slowed(model, found, spinning) if resisted else None,
            'whirls': _whirls(model, found, whirled), 'tops': _tops(model, axes, free)}


def all_axes(model):
    """Return what principal_axes returns for each inertia matrix: (m, 3) and (m, 3, 3)."""
    if model.inertia is None:
        return None
    moments, axes = zip(*map(principal_axes, model.inertia))
    return np.array(moments), np.array(axes)


def _spins(found, inertias):
    if not inertias:
        return None
    accelerations = [[component / inertia for component in found[i].torque]
                     for i, inertia in inertias.items()]
    return Spins(np.array([*inertias]), np.array([*inertias.values()]), np.array(accelerations))


def _slowed(model, found, inertias):
    spins = _spins(found, inertias)
    if spins is None:
        return None
    return Slowed(*spins, model.air.rotational_drag, model.air.angular_velocity or (0.0, 0.0, 0.0))


def _whirls(model, found, inertias):
    slowed = _slowed(model, found, inertias)
    if slowed is None:
        return None
    decays, count = [slowed.drag / inertia for inertia in inertias.values()], len(inertias)
    return Whirls(*slowed, np.array(decays), np.array([found[i].final for i in inertias]),
                  np.empty((count, TERMS, 4)), np.empty((count, 4)), np.zeros(1, dtype=bool))


def _tops(model, axes, free):
    """Return the Tops that bodies number `free` of those with an inertia matrix are."""
    if not free:
        return None
    parts = model.general_body, *axes
    if len(free) < len(model.general_body):
        parts = [part[free] for part in parts]
    return Tops(*parts, np.empty((len(free), TOP_SIZE)), np.zeros(1, dtype=bool))
