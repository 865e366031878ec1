# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The plots of a page: which of them are there, and what they show."""

from __future__ import annotations

import numpy as np

from .thin import thinned
from .units import prefixed

_COLORS = {'x': '#c9342b', 'y': '#2c7a3d', 'z': '#2456c4', 'w': '#2b2f36', 'drift': '#2b2f36',
           'kinetic': '#c2661a', 'gravitational': '#7a5aa6', 'spring': '#1b8484',
           'total': '#2b2f36', 'damper': '#963ca5', 'air': '#14797d', 'anchor': '#c9342b',
           'push': '#2456c4'}
_HEIGHT = 112
# Room for numbers below and beside the area of a plot.
_AXES = tuple({'size': size, 'ticks': {'show': False}, 'gap': 3} for size in (34, 46))
# Zooming is done for all plots at once, with the section.
_CURSOR = {'drag': {'x': False, 'y': False, 'setScale': False}, 'sync': {'key': 'time'}}
# The instant that is shown, as a line over the area of every plot, which is what .u-over is.
_CURSOR_LINE = ('<style>.uplot .u-over::after{content:"";position:absolute;top:0;bottom:0;'
                'left:%.4f%%;border-left:2px solid #d9480f;pointer-events:none}</style>')


class Plots:
    """
    The plots of one group of a catalogue at a time.

    gui: viser's GuiApi, in whose present container they are put; groups: {name: [Plot]};
    chosen: called, without arguments, when another group was chosen. shown: [Plot].
    """

    def __init__(self, gui, groups, chosen):
        self._groups = groups
        self._chosen = chosen
        self.menu = gui.add_dropdown('plots', tuple(groups), hint='which numbers to plot')
        self._style = gui.add_html('')
        # As many as the largest group has, for ever: of a chart that is removed, a browser that
        # is behind would complain about what it is told of it.
        blank = {'data': (np.zeros(2),) * 2, 'series': ({}, {})}
        self._charts = [gui.add_uplot(**blank, scales={'x': {'time': False}}, axes=_AXES,
                                      cursor=_CURSOR, height=_HEIGHT, visible=False)
                        for _ in range(max(map(len, groups.values())))]
        self.shown = groups[self.menu.value]

    @property
    def topics(self):
        """Return the topics that the plots need."""
        return {plot.topic for plot in self.shown}

    def choose(self, group):
        """Show another group."""
        self.shown = self._groups[group]
        for chart in self._charts:
            chart.visible = False
        self._chosen()

    def draw(self, tables, start, end):
        """Draw from one time to another [s]; tables: {topic: Table}."""
        for chart, plot in zip(self._charts, self.shown):
            table = tables.get(plot.topic)
            first, last = table.between(start, end) if table is not None else (0, 0)
            if last - first > 1:
                _draw(chart, plot, table, thinned(table.values, first, last, plot.columns))

    def mark(self, share):
        """Mark an instant: its share, 0 to 1, of the time that is drawn; None for no mark."""
        self._style.content = '' if share is None else _CURSOR_LINE % (100.0 * share)


def _draw(chart, plot, table, rows):
    """Give a chart some rows of a table to show."""
    values = table.values[rows][:, plot.columns]
    unit, factor = prefixed(plot.unit, float(np.abs(values).max()))
    title = f'{plot.title} [{unit}]' if unit else plot.title
    # Browsers make a chart anew, empty at first, whenever they are told of more than its data.
    if title != chart.title:
        chart.title = title
        chart.series = ({'label': 't [s]'}, *(
            {'label': label, 'stroke': _COLORS[label], 'width': 1.3} for label in plot.labels))
    chart.data = (table.time[rows], *(values * factor).T)
    chart.visible = True
