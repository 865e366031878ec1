# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The 3-D view of a scene: floor, bodies, anchors, springs, forces, trails."""

from __future__ import annotations

from .arrows import Arrows
from .body_view import AnchorView, BodyView
from .space import Space
from .spring_view import SpringView
from .trail import Trail

WORLD = '/world'


class Stage:
    """
    Draws a scene and moves what is drawn.

    api: viser's SceneApi; scene: Scene; space: Space to draw in; topics: those of the run,
    relative to the node. followed: the name of the body that stays in the middle, or None.
    """

    def __init__(self, api, scene, space: Space, topics):
        self.api = api
        self.space = space
        self.scene = scene
        self.followed = scene.bodies[0].name if space.is_left else None
        # All that is drawn lies in it: to follow a body is to move the world.
        self._world = api.add_frame(WORLD, show_axes=False)
        self._sun = space.draw(api, WORLD)
        self.bodies = {body.name: BodyView(api, f'{WORLD}/{body.name}', body, space, i)
                       for i, body in enumerate(scene.bodies)}
        self.anchors = {anchor.name: AnchorView(api, f'{WORLD}/{anchor.name}', anchor, space)
                        for anchor in scene.anchors}
        self.springs = [SpringView(api, f'{WORLD}/{spring.name}', spring, space)
                        for spring in scene.springs]
        self.arrows = Arrows(api, f'{WORLD}/forces', scene, space, topics)
        self.trails = {body.name: Trail(api, f'{WORLD}/{body.name}_trail', space)
                       for body in scene.bodies}
        # How much of the past they show [s].
        self.trail_seconds = 2.0
        self.names_shown = len(scene.bodies) > 1
        self.show({})

    @property
    def offset(self):
        """Return where the world's origin is shown: (3,) [m]."""
        return self._world.position

    @property
    def names_shown(self):
        """Tell whether bodies and anchors have their names beside them."""
        return self._names_shown

    @names_shown.setter
    def names_shown(self, shown):
        self._names_shown = shown
        for view in (*self.bodies.values(), *self.anchors.values()):
            view.label.visible = shown

    @property
    def shadows_shown(self):
        """Tell whether things cast shadows; they take as long to draw as all else together."""
        return self._sun.cast_shadow

    @shadows_shown.setter
    def shadows_shown(self, shown):
        self._sun.cast_shadow = shown

    def set_scene(self, scene):
        """Draw the scene with other quantities: the same members, of other sizes."""
        self.scene = scene
        for body in scene.bodies:
            self.bodies[body.name].set_body(body)
        for view, spring in zip(self.springs, scene.springs):
            view.set_spring(spring)

    def show(self, rows):
        """
        Draw an instant.

        rows: {topic: (k,) numbers of its message}; what a topic is missing for stays as it is.
        """
        for name, view in (*self.bodies.items(), *self.anchors.items()):
            row = rows.get(f'{name}/pose')
            if row is not None:
                view.show(row)
        ends = {**self.bodies, **self.anchors}
        for view in self.springs:
            view.show(ends)
        self.arrows.show(rows, self.bodies)
        if self.followed is not None:
            self._world.position = self.space.middle - self.bodies[self.followed].position
        elif self.offset.any():
            self._world.position = (0.0, 0.0, 0.0)

    def draw_trails(self, tables, now):
        """Draw where the bodies were up to a time [s]; tables: {topic: Table}."""
        for name, trail in self.trails.items():
            trail.show(tables.get(f'{name}/pose'), now - self.trail_seconds, now)
