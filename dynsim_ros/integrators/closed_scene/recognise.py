# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""From a model, what acts on it and a state to a motion in closed form, if it has one."""

import math

from .equilibrium import is_equilibrium, moves
from .hold import holds_of
from .motion import Balance, ClosedScene
from .openness import Openness
from .rotations import all_axes, rotations
from .translations import flights, SingleBody
from .works import spin_energy
from ..entry import entry
from ...physics.energies import energies


class Recogniser:
    """
    Tells whether the motion from a state on has a closed form.

    model: Model; drive: Drive, whose arrays are read whenever a motion begins.
    """

    def __init__(self, model, drive):
        self._model, self._drive = model, drive
        self._axes = all_axes(model)
        self._openness = Openness(model, drive)
        self._energies = None

    def closed_scene(self, state):
        """Return the ClosedScene of the motion from a state (size,) on, or None."""
        model, drive = self._model, self._drive
        if self._openness.is_plain(state):
            return None
        is_still = not moves(model, state)
        if model.springs is not None and model.several is not None and not is_still:
            return None
        start = state.copy()
        for i in range(model.rigid):
            q = start[6 * len(model.mass) + 4 * i:][:4]
            q /= math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
        holds = holds_of(model, drive.anchors)
        if is_still and is_equilibrium(model, drive, start, holds):
            return self._scene(start)
        return self._moving(start, holds)

    def _scene(self, start, **parts):
        model = self._model
        none = dict.fromkeys(ClosedScene._fields)
        return ClosedScene(**none | {'start': start, 'bodies': len(model.mass),
                                     'rigid': model.rigid} | parts)

    def _moving(self, start, holds):
        centre = self._centre(start, holds)
        if centre is None:
            return None
        turning = rotations(self._model, self._drive, start, self._axes)
        if turning is None:
            return None
        holding = centre.pop('holding', None)
        return self._scene(start, **centre, **turning, balance=self._balance(start, holding))

    def _centre(self, start, holds):
        """Return what moves the centres of mass, as fields of ClosedScene, or None."""
        model = self._model
        if not holds:
            return {'flights': flights(model, self._drive)}
        if model.several is not None or any(hold.anchor is None for hold in holds):
            return None
        body = SingleBody(model, self._drive, start, holds)
        for kind, found in (('centred', body.centred()), ('line', body.line())):
            if found is not None:
                return {kind: found[0], 'holding': found[1]}
        return None

    def _balance(self, start, holding):
        model, drive = self._model, self._drive
        if drive.works is None:
            return None
        anchors, air = drive.anchors.copy(), model.air
        if self._energies is None:
            self._energies = entry(energies, model, anchors, 0.0, start)
        kinetic, gravitational, spring = self._energies(model, anchors, 0.0, start)
        return Balance(model, anchors, None if drive.pushes is None else drive.pushes.copy(),
                       air is not None, air is not None and air.rotational_drag is not None,
                       kinetic + gravitational + spring,
                       spin_energy(model, len(model.mass), model.rigid, start), holding)
