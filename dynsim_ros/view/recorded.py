# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The page of a recorded run."""

from __future__ import annotations

import time

import numpy as np

from .catalogue import ENERGY, IMBALANCE
from .page import Page
from .playback import Playback
from .space import Space

_SPEEDS = ('0.05', '0.1', '0.25', '0.5', '1', '2', '5', '10')
# While somebody moves a slider it is not moved for him [s].
_HANDS_OFF = 0.4
# How often the numbers on the page are brought up to date [Hz].
_TEXT_RATE = 10.0


class RecordedPage(Page):
    """Shows a RecordedRun."""

    def __init__(self, server, run):
        super().__init__(server, run.scene, space_of(run), run.tables)
        self._run = run
        self._rows = None
        self._hands_off = self._next_text = 0.0
        self.playback = Playback(run.start, max(run.end, run.start + 1e-3))
        pose = run.tables[f'{run.scene.bodies[0].name}/pose']
        self._tick = float(np.median(np.diff(pose.time))) if len(pose.time) > 1 else 0.01
        self._set_up()
        self.add_looks()
        self.plots_changed()

    def frame(self, seconds):
        """Go on by so much time [s] and show the instant."""
        if not self.is_watched:
            return
        self.playback.advance(seconds)
        self._show()
        now = time.monotonic()
        if now >= self._next_text:
            self._next_text = now + 1.0 / _TEXT_RATE
            self._tell(now)

    def plots_changed(self):
        """Draw the plots over the section that is played."""
        self.plots.draw(self._run.tables, self.playback.start, self.playback.end)

    def _show(self):
        playback, tables = self.playback, self._run.tables
        self.stage.show({topic: table.at(playback.time) for topic, table in tables.items()})
        self.stage.draw_trails(tables, playback.time)
        self.plots.mark((playback.time - playback.start) / (playback.end - playback.start))

    def _tell(self, now):
        """Bring the controls and numbers up to date."""
        playback = self.playback
        if now > self._hands_off:
            self._time.value = round(playback.time, 4)
        self._play.label = 'Pause' if playback.is_playing else 'Play'
        energy = self._run.tables.get(ENERGY)
        if energy is not None:
            row = energy.at(playback.time)
            self._text.content = (f'energy {row[3]:.6g} J, drift {row[IMBALANCE]:.2g} J')

    def _set_up(self):
        gui, playback = self.gui, self.playback
        first, last = playback.first, playback.last
        step = max(1e-4, 1e-6 * (last - first))
        self._play = gui.add_button('Pause')
        self._time = gui.add_slider('time [s]', first, last, step, first)
        steps = gui.add_button_group('step', ('start', '- tick', '+ tick'))
        speed = gui.add_dropdown('speed', _SPEEDS, initial_value='1')
        repeat = gui.add_checkbox('loop', True)
        section = gui.add_multi_slider('section [s]', first, last, step, (first, last),
                                       min_range=min(10 * step, last - first))
        self._section = section
        self._text = gui.add_markdown('')
        self.when_pressed(self._play, playback.toggle)
        self.when(self._time, self._seek)
        self.when(speed, lambda value: setattr(playback, 'speed', float(value)))
        self.when(repeat, lambda value: setattr(playback, 'repeats', value))
        self.when(section, self._choose)

        @steps.on_click
        async def _(event):
            which = event.target.value
            self.later(lambda: self._step(which))

        self.on_key('play or pause', 'space', playback.toggle)
        self.on_key('one tick back', 'arrowleft', lambda: self._step('- tick'))
        self.on_key('one tick on', 'arrowright', lambda: self._step('+ tick'))
        self.on_key('to the start', 'home', lambda: self._step('start'))
        self.on_key('to the end', 'end', lambda: playback.seek(playback.end))
        self.on_key('back by 5 %', 'arrowleft', lambda: self._stride(-0.05), 'shift')
        self.on_key('on by 5 %', 'arrowright', lambda: self._stride(0.05), 'shift')
        # A section is chosen by mouse only otherwise.
        self.on_key('section: from here', 'I', lambda: self._cut(playback.time, playback.end))
        self.on_key('section: up to here', 'O', lambda: self._cut(playback.start, playback.time))
        self.on_key('section: the whole run', 'W', lambda: self._cut(first, last))

    def _seek(self, value):
        self._hands_off = time.monotonic() + _HANDS_OFF
        self.playback.seek(value)

    def _choose(self, ends):
        self.playback.choose(*ends)
        self.plots_changed()

    def _cut(self, start, end):
        """Play only from one time to another [s], unless that is next to nothing."""
        if end - start >= self._section.min_range:
            self._section.value = start, end
            self._choose((start, end))

    def _stride(self, share):
        """Go on by a share of the section."""
        playback = self.playback
        playback.seek(playback.time + share * (playback.end - playback.start))

    def _step(self, which):
        playback = self.playback
        if which != 'start':
            playback.is_playing = False
        shift = {'start': -playback.last, '- tick': -self._tick, '+ tick': self._tick}[which]
        playback.seek(playback.time + shift)


def space_of(run):
    """Return the Space that a run takes."""
    names = [member.name for member in (*run.scene.bodies, *run.scene.anchors)]
    paths = [run.tables[f'{name}/pose'].values[:, :3] for name in names
             if f'{name}/pose' in run.tables]
    return Space(run.scene, np.concatenate(paths))
