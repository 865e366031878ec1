# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the pages of recorded and of live runs have in common."""

from __future__ import annotations

import math
from queue import Empty, SimpleQueue
import time

from .arrows import COLORS as ARROW_COLORS
from .catalogue import catalogue
from .plots import Plots
from .spring_view import COLORS as SPRING_COLORS
from .stage import Stage

_PLOTS_WIDTH, _CONTROLS_WIDTH, _LOOKS_HEIGHT = 380, 310, 380
# How often what is shown is brought up to date [Hz].
RATE = 30.0
# Small print stands out enough from what is behind it to be read, also with `?darkMode`; icons and
# fields for numbers are large enough to be hit.
_STYLE = """<style>
:root{--mantine-color-dimmed:#4a5056!important}
:root[data-mantine-color-scheme=dark]{--mantine-color-dimmed:#b8bdc3!important}
.mantine-Slider-markLabel,.multi-slider-mark-label{color:var(--mantine-color-dimmed)!important}
.mantine-ActionIcon-root{min-width:26px;min-height:26px}
[data-with-right-section]>.mantine-NumberInput-input{min-height:24px!important}
</style>"""


class Page:
    """
    A page: the 3-D view, a panel of plots, and in the main panel how they are shown.

    server: viser's; scene: Scene; space: Space; topics: those that the run has, relative to its
    node. Browsers ask in threads of viser; all is done in the one that calls run().
    """

    def __init__(self, server, scene, space, topics):
        self.server = server
        self.gui = server.gui
        self._asked = SimpleQueue()
        space.look(server.initial_camera)
        self.stage = Stage(server.scene, scene, space, topics)
        server.on_client_connect(self._look_from_afar)
        panel = self.gui.add_panel()
        # Without icons: to look for one in viser's archive of 4285 takes 60 ms.
        with panel.add_tab('plots'):
            self.plots = Plots(self.gui, catalogue(scene, topics), self.plots_changed)
        panel.dock_left()
        panel.set_width(_PLOTS_WIDTH)
        self.gui.main_panel.dock_right()
        self.gui.main_panel.set_width(_CONTROLS_WIDTH)
        self.when(self.plots.menu, self.plots.choose)
        self.gui.add_html(_STYLE)

    async def _look_from_afar(self, client):
        """Let a browser look at all, however wide its view is, until somebody turns it."""
        space, start = self.stage.space, self.server.initial_camera.position
        placed = start

        def is_at(camera, position):
            return math.dist(camera.position, position) < 1e-3 * space.size

        async def look(camera):
            nonlocal placed
            position, _ = space.viewpoint(camera.aspect)
            # A page that is slow to start goes to where all begin once more.
            is_untouched = is_at(camera, placed) or is_at(camera, start)
            if is_untouched and not is_at(camera, position):
                space.look(camera, camera.aspect)
                placed = position

        client.camera.on_update(look)
        await look(client.camera)

    def later(self, action):
        """Have action() done before the next frame; from any thread."""
        self._asked.put(action)

    def when(self, control, action):
        """Have action(value) done whenever a browser sets a control."""
        @control.on_update
        async def _(event):
            if event.client is not None:
                # As it is now: until the action is done, another value may be shown.
                value = control.value
                self.later(lambda: action(value))

    def when_pressed(self, button, action):
        """Have action() done whenever a button is pressed in a browser."""
        @button.on_click
        async def _(_):
            self.later(action)

    def on_key(self, label, key, action, modifier=None):
        """Have action() done on a key, and as a command of the palette; modifier: 'shift', …."""
        @self.gui.add_command(label, hotkey=key, modifier=modifier).on_trigger
        async def _(_):
            self.later(action)

    def run(self, stopped, frame, wait=time.sleep):
        """
        Carry out what browsers ask for and frame(seconds since the last one) until stopped().

        wait(seconds): returns after so long or sooner.
        """
        last = due = time.monotonic()
        while not stopped():
            left = due - time.monotonic()
            if left > 0.0:
                wait(left)
                continue
            now = time.monotonic()
            due = max(due + 1.0 / RATE, now)
            with self.server.atomic():
                self._carry_out()
                frame(now - last)
            last = now

    @property
    def is_watched(self):
        """Tell whether any browser is there."""
        return bool(self.server.get_clients())

    def plots_changed(self):
        """Take note that other plots are shown; for those who derive from it."""

    def add_looks(self):
        """Add the panel in which one chooses what the 3-D view shows."""
        stage, gui = self.stage, self.gui
        # No folder: its head cannot be reached by the keyboard.
        panel = gui.add_panel()
        with panel.add_tab('3-D view'):
            if stage.arrows.kinds:
                gui.add_html(_legend())
            for kind in stage.arrows.kinds:
                box = gui.add_checkbox(f'force: {kind}', kind in stage.arrows.shown)
                self.when(box, lambda shown, kind=kind: stage.arrows.choose(kind, shown))
            scale = stage.arrows.scale
            if stage.arrows.kinds:
                slider = gui.add_slider('arrows [m/N]', 0.0, 4.0 * scale, 0.04 * scale, scale)
                self.when(slider, lambda value: setattr(stage.arrows, 'scale', value))
            trail = gui.add_slider('trail [s]', 0.0, 10.0, 0.1, stage.trail_seconds)
            self.when(trail, lambda value: setattr(stage, 'trail_seconds', value))
            names = gui.add_checkbox('names', stage.names_shown)
            self.when(names, lambda shown: setattr(stage, 'names_shown', shown))
            shadows = gui.add_checkbox('shadows', stage.shadows_shown,
                                       hint='slow where there is no graphics card')
            self.when(shadows, lambda shown: setattr(stage, 'shadows_shown', shown))
            followed = gui.add_dropdown(
                'follow', ('nothing', *stage.bodies), initial_value=stage.followed or 'nothing')
            self.when(followed, self._follow)
        panel.dock_below(gui.main_panel)
        panel.set_height(_LOOKS_HEIGHT)

    def _follow(self, name):
        self.stage.followed = None if name == 'nothing' else name

    def _carry_out(self):
        try:
            while True:
                self._asked.get_nowait()()
        except Empty:
            pass


def _legend():
    """Return the meaning of the colours as HTML."""
    arrows = ' '.join(f'<span style="white-space:nowrap"><b style="color:rgb{color}">&#10230;</b> '
                      f'{kind}</span>' for kind, color in ARROW_COLORS.items())
    low, middle, high = (f'rgb{tuple(map(int, color))}' for color in SPRING_COLORS)
    return ('<div style="font-size:0.8em;padding:0 0.8em 0.6em">'
            f'{arrows}<div style="display:flex;gap:0.5em;align-items:center">springs: pushing'
            f'<div style="flex:1;height:0.6em;background:linear-gradient(90deg,{low},{middle},'
            f'{high})"></div>pulling</div></div>')
