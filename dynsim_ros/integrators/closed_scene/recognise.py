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
        self._energies, self._acting = None, None

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
            w, x, y, z = q.tolist()
            q /= math.sqrt(w * w + x * x + y * y + z * z)
        self._look_at_what_acts()
        if is_still and is_equilibrium(model, drive, start, self._holds):
            return ClosedScene(start, len(model.mass), model.rigid)
        return self._moving(start)

    def _look_at_what_acts(self):
        """Find what depends on nothing but what acts, where that is no longer what it was."""
        model, drive = self._model, self._drive
        acting = drive.anchors.tobytes(), drive.pushes is not None and drive.pushes.tobytes()
        if acting == self._acting:
            return
        self._acting, self._holds = acting, holds_of(model, drive.anchors)
        self._body = self._always = None
        if not self._holds:
            self._always = {'flights': flights(model, drive)}, None
        elif model.several is None and all(hold.anchor is not None for hold in self._holds):
            self._body = SingleBody(model, drive, self._holds)
            self._always = self._body.centred()

    def _moving(self, start):
        model, centre = self._model, self._always
        if centre is None and self._body is not None:
            centre = self._body.line(start)
        if centre is None:
            return None
        turning = rotations(model, self._drive, start, self._axes)
        if turning is None:
            return None
        moved, holding = centre
        return ClosedScene(start, len(model.mass), model.rigid, **moved, **turning,
                           balance=self._balance(start, holding))

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
