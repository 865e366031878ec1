# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What browsers do to a run with the mouse: move anchors, pull at bodies."""

from __future__ import annotations

import time

import numpy as np

from .stage import WORLD

# How often a pull is sent again while it lasts [Hz]: what nobody renews ends by itself.
_RATE = 15.0


class Gizmos:
    """
    A gizmo at each anchor; to drag it is to command the anchor.

    page: Page; move: called with the name of an anchor and a position (3,) [m].
    """

    def __init__(self, page, move):
        self._page = page
        self._move = move
        self._gizmos = {}
        self._wanted = {}
        # Which browser drags which anchor.
        self._holders = {}
        stage = page.stage
        for name in stage.anchors:
            gizmo = stage.api.add_transform_controls(
                f'{WORLD}/{name}_gizmo', 0.3 * stage.space.size, disable_rotations=True,
                line_width=3.0, depth_test=False, position=stage.anchors[name].position)
            self._gizmos[name] = gizmo
            self._listen(name, gizmo)

    def release(self, client):
        """Take note that a browser has gone."""
        self._holders = {name: holder for name, holder in self._holders.items()
                         if holder != client}

    def act(self):
        """Command what is dragged; put the other gizmos to where their anchors are."""
        wanted, self._wanted = self._wanted, {}
        for name, position in wanted.items():
            self._move(name, position)
        for name, gizmo in self._gizmos.items():
            if name not in self._holders:
                gizmo.position = self._page.stage.anchors[name].position

    def _listen(self, name, gizmo):
        @gizmo.on_update
        async def _(event):
            place, phase, client = np.array(gizmo.position), event.phase, event.client_id
            self._page.later(lambda: self._drag(name, place, phase, client))

    def _drag(self, name, place, phase, client):
        self._wanted[name] = place
        if phase == 'end':
            self._holders.pop(name, None)
        else:
            self._holders[name] = client


class Pulls:
    """
    Bodies can be pulled at: a force from the point that was grabbed towards the pointer.

    page: Page; push: called with the name of a body, a force (3,) [N] and a torque (3,) [N m].
    stiffness: force per distance [N/m].
    """

    def __init__(self, page, push, stiffness):
        self.stiffness = stiffness
        self._page = page
        self._push = push
        # {name of a body: (grabbed point in body axes from its centre [m], pointer in world [m])}
        self._pulls = {}
        self._next = 0.0
        for name, view in page.stage.bodies.items():
            for mesh in view.meshes:
                self._listen(name, mesh)

    def act(self):
        """Push what is pulled at."""
        now = time.monotonic()
        if not self._pulls or now < self._next:
            return
        self._next = now + 1.0 / _RATE
        for name, (arm, pointer) in self._pulls.items():
            view = self._page.stage.bodies[name]
            lever = view.rotation.apply(arm)
            force = self.stiffness * (pointer - view.position - lever)
            self._push(name, force, np.cross(lever, force) if view.turns else np.zeros(3))

    def _listen(self, name, mesh):
        # viser ends a drag itself when its browser goes.
        @mesh.on_drag('left')
        async def _(event):
            start, end = np.array(event.start_position), np.array(event.end_position)
            phase = event.phase
            self._page.later(lambda: self._drag(name, start, end, phase))

    def _drag(self, name, start, end, phase):
        stage = self._page.stage
        view, pointer = stage.bodies[name], end - stage.offset
        if phase == 'end':
            self._pulls.pop(name, None)
            self._push(name, np.zeros(3), np.zeros(3))
        elif phase == 'start' or name not in self._pulls:
            arm = view.rotation.inverse().apply(start - stage.offset - view.position)
            self._pulls[name] = (arm, pointer)
        else:
            self._pulls[name] = (self._pulls[name][0], pointer)
