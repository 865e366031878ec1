# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which rotations have a closed form when no spring exerts a moment, and their constants."""

import numpy as np

from .motion import Slowed, Spins, Tops, Whirls
from .rotation import rotations_of
from .tops import laid_flat
from ..closed_form import constant_of_whirl, principal_axes, torque_free_in_full, whirl_series


def rotations(model, drive, start, axes):
    """
    Return {'spins', 'slowed', 'whirls', 'tops'}, as in ClosedScene, or None.

    None: a rotation has no closed form. Nothing rotates: {}. start: the state, its quaternions
    normalised; axes: from all_axes.
    """
    if model.rigid == 0:
        return {}
    found = rotations_of(model, drive, start)
    spinning, whirled, free = {}, {}, {}
    if model.round_body is not None:
        for i, inertia in zip(model.round_body.tolist(), model.round_inertia.tolist()):
            if found[i].keeps_axis:
                spinning[i] = inertia
            elif found[i].is_soon_stopped(inertia):
                whirled[i] = inertia
            else:
                return None
    if model.general_body is not None:
        for i, matrix, axis in zip(model.general_body.tolist(), model.inertia.tolist(), axes):
            if found[i].is_free:
                free[i] = laid_flat(torque_free_in_full(*axis, found[i].orientation,
                                                        found[i].omega))
            elif (inertia := found[i].inertia_about_axis(matrix)) is not None:
                spinning[i] = inertia
            else:
                return None
    resisted = model.air is not None and bool(model.air.rotational_drag)
    return {'spins': None if resisted else _spins(found, spinning),
            'slowed': _slowed(model, found, spinning) if resisted else None,
            'whirls': _whirls(model, found, whirled), 'tops': _tops(free)}


def all_axes(model):
    """Return what principal_axes returns for each body with an inertia matrix."""
    return [] if model.inertia is None else [principal_axes(matrix) for matrix in model.inertia]


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
    decays = [slowed.drag / inertia for inertia in inertias.values()]
    series = [whirl_series(found[i].omega, found[i].final, decay)
              for i, decay in zip(inertias, decays)]
    constants = [constant_of_whirl(coefficients, found[i].orientation)
                 for i, coefficients in zip(inertias, series)]
    return Whirls(*slowed, np.array(decays), np.array([found[i].final for i in inertias]),
                  np.array(series), np.array(constants))


def _tops(constants):
    if not constants:
        return None
    return Tops(np.array([*constants]), np.array([*constants.values()]))
