# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Forces on bodies as arrows from their centres of mass."""

from __future__ import annotations

import numpy as np

from .catalogue import WRENCHES

COLORS = {'spring': (230, 95, 20), 'damper': (150, 60, 170), 'air': (20, 145, 150),
          'gravity': (120, 100, 60), 'net': (30, 34, 40)}
SHOWN = ('spring', 'gravity', 'net')


class Arrows:
    """
    Arrows of all kinds of forces that a run has.

    kinds: those, in order; shown: the set of those that are drawn; scale: length of an arrow [m]
    for each N.
    """

    def __init__(self, api, name, scene, space, topics):
        self.kinds = [kind for kind in WRENCHES
                      if any(_topic(body.name, kind) in topics for body in scene.bodies)]
        self.shown = {kind for kind in self.kinds if kind in SHOWN}
        self.scale = 0.35 * space.size / _usual_force(scene, space)
        self._shortest = 0.05 * space.size
        # Arrows move with a frame, as bodies do: what else they are is drawn a little later.
        self._frames = {body.name: api.add_frame(f'{name}/{body.name}', show_axes=False)
                        for body in scene.bodies}
        self._arrows = {
            (body.name, kind): api.add_arrows(
                f'{name}/{body.name}/{kind}', np.zeros((1, 2, 3)), COLORS[kind],
                shaft_radius=0.008 * space.size, head_radius=0.02 * space.size,
                head_length=self._shortest, visible=kind in self.shown)
            for body in scene.bodies for kind in self.kinds
            if _topic(body.name, kind) in topics}

    @property
    def topics(self):
        """Return the topics that the arrows that are drawn need."""
        return {_topic(body, kind) for body, kind in self._arrows if kind in self.shown}

    def choose(self, kind, shown):
        """Draw a kind of force, or no longer."""
        (self.shown.add if shown else self.shown.discard)(kind)
        for (_, of), arrow in self._arrows.items():
            if of == kind:
                arrow.visible = shown

    def show(self, rows, bodies):
        """Draw the forces of an instant; rows: as for Stage.show; bodies: {name: BodyView}."""
        for body, frame in self._frames.items():
            frame.position = bodies[body].position
        for (body, kind), arrow in self._arrows.items():
            if kind in self.shown:
                arrow.points = self._points(rows.get(_topic(body, kind)))

    def _points(self, row):
        """Return the ends of an arrow, from the centre of mass: (1, 2, 3) [m]."""
        force = np.zeros(3) if row is None else self.scale * row[:3]
        # What is shorter than its head hides within the body.
        if np.linalg.norm(force) < self._shortest:
            force = np.zeros(3)
        return np.array([[np.zeros(3), force]], np.float32)


def _topic(body, kind):
    return f'{body}/wrench/{kind}'


def _usual_force(scene, space):
    """Return the size of the forces in a scene [N]."""
    weights = [body.mass * scene.gravity for body in scene.bodies] if scene.gravity else []
    pulls = [0.3 * spring.stiffness * (spring.natural_length or space.size)
             for spring in scene.springs if spring.stiffness]
    return max(weights or pulls or [body.mass for body in scene.bodies])
