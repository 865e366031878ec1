# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Panels drawn as a figure for print."""

from __future__ import annotations

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
import matplotlib.style
from matplotlib.ticker import FixedLocator, Formatter, MaxNLocator
import numpy as np

from .plot_comparison import DIFFERENCE, difference
from .plot_panels import Block, Panel
from .plot_scale import limits, prefixed
from .plot_sheet import Box, KEY_LINE, LEFT, Place, Sheet
from .plot_thinning import thinned

# The palette of Okabe and Ito, whose colours colour-blind people can tell apart.
_BLACK, _ORANGE, _SKY, _GREEN, _BLUE, _RED, _PURPLE = (
    '#000000', '#E69F00', '#56B4E9', '#009E73', '#0072B2', '#D55E00', '#CC79A7')
_COLOURS = {'x': _RED, 'y': _GREEN, 'z': _BLUE, 'w': _PURPLE, 'kinetic': _ORANGE,
            'gravitational': _SKY, 'spring': _GREEN, 'total': _BLACK, 'damper': _BLUE,
            'air': _PURPLE, 'anchor': _RED, 'push': _ORANGE, 'imbalance': _BLACK}
_OTHERS = (_BLUE, _ORANGE, _GREEN, _RED, _PURPLE, _SKY, _BLACK)
# One run; of two the first one, broad and pale below the other.
_LINE, _BROAD = {'linewidth': 0.9}, {'linewidth': 2.4, 'alpha': 0.4}
_STYLE = {
    'font.family': 'DejaVu Sans', 'font.size': 8, 'axes.labelsize': 8, 'xtick.labelsize': 7,
    'ytick.labelsize': 7, 'legend.fontsize': 7.5, 'axes.linewidth': 0.6, 'grid.linewidth': 0.5,
    'xtick.major.width': 0.6, 'ytick.major.width': 0.6, 'xtick.major.size': 2.5,
    'ytick.major.size': 2.5, 'axes.spines.top': False, 'axes.spines.right': False,
    'axes.grid': True, 'grid.color': '#DDDDDD', 'axes.axisbelow': True,
    'legend.frameon': False, 'legend.borderaxespad': 0.0, 'legend.handlelength': 1.4,
    'legend.columnspacing': 1.2, 'legend.labelspacing': 0.2, 'legend.borderpad': 0.2,
    'pdf.fonttype': 42, 'svg.hashsalt': 'dynsim_ros'}
# Dots an inch of a PNG. Columns an inch that curves are thinned to: four a dot, by which lines
# look as if all were drawn, or what print can show.
_DOTS = 200
_FINE, _PRINT = 4 * _DOTS, 300
# Nothing of when a file was made: the same panels give the same bytes.
_METADATA = {'.png': {}, '.pdf': {'CreationDate': None}, '.svg': {'Date': None}}
ENDINGS = tuple(_METADATA)


def draw(bands: list[list[Block]], time_label: str, path: Path,
         names: tuple[str, str] | None = None) -> Figure:
    """
    Draw panels, see plot_panels.bands, into a file: PNG, PDF or SVG by its ending.

    names: of the two runs, where panels have another one to compare with. Returns the figure.
    """
    with matplotlib.style.context(['default', _STYLE]):
        fineness = _FINE if path.suffix == '.png' else _PRINT
        figure = _Drawing(Sheet(bands), time_label, names, fineness).figure
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path, dpi=_DOTS, metadata=_METADATA[path.suffix])
    return figure


class _Drawing:
    """A figure, drawn."""

    def __init__(self, sheet: Sheet, time_label: str, names: tuple[str, str] | None,
                 fineness: int):
        self.figure = Figure(figsize=(sheet.width, sheet.height))
        self._size, self._fineness = (sheet.width, sheet.height), fineness
        self._time_label = time_label
        panels = [place.panel for place in sheet.places]
        times = [part.time for panel in panels for part in (panel, panel.other) if part]
        self._span = min(time[0] for time in times), max(time[-1] for time in times)
        if self._span[0] == self._span[1]:
            self._span = self._span[0] - 0.5, self._span[1] + 0.5
        for text, left, top in sheet.headings:
            self.figure.text(left / sheet.width, 1.0 - top / sheet.height, text, va='top',
                             size=9, weight='bold')
        self._add_key({name for panel in panels for name in panel.curves}, names)
        for place in sheet.places:
            self._add(place)

    def _add_key(self, curves: set[str], names: tuple[str, str] | None):
        """Tell once what the colours of axes mean, and which run is which."""
        axes = {name: name for name in 'xyz'} | {'w': 'w of orientation'}
        lines = [[(Line2D([], [], color=_COLOURS[name]), label)
                  for name, label in axes.items() if name in curves]]
        if names:
            lines.append([*((Line2D([], [], color=_BLACK, **style), name)
                            for name, style in zip(names, (_BROAD, _LINE))),
                          (Line2D([], [], linestyle=''), f'{DIFFERENCE}: thin − broad')])
        width, height = self._size
        for number, line in enumerate(filter(None, lines)):
            self.figure.legend(*zip(*line), loc='upper left', ncols=len(line), bbox_to_anchor=(
                LEFT / width, 1.0 - (0.08 + KEY_LINE * number) / height))

    def _add(self, place: Place):
        """Draw a panel, and how much another run differs."""
        panel, other = place.panel, place.panel.other
        axes = self._axes(place.box, [panel, other] if other else [panel],
                          place.is_lowest and place.difference is None)
        if other:
            self._draw(axes, panel, panel.shown, _BROAD)
        self._draw(axes, other or panel, panel.shown, _LINE)
        if panel.has_key:
            lines = [Line2D([], [], color=_colour(name, panel.shown)) for name in panel.shown]
            axes.legend(lines, panel.shown, loc='lower left', bbox_to_anchor=(0.0, 1.02), ncols=2)
        if place.difference:
            differing = difference(panel)
            below = self._axes(place.difference, [differing], place.is_lowest)
            self._draw(below, differing, list(differing.curves), _LINE)

    def _axes(self, box: Box, panels: list[Panel], has_times: bool) -> Axes:
        """Return empty axes for some panels of one quantity."""
        width, height = self._size
        axes = self.figure.add_axes((box.left / width, 1.0 - (box.top + box.height) / height,
                                     box.width / width, box.height / height))
        low, high, largest = limits([curve for panel in panels for curve in panel.curves.values()])
        unit, scale = prefixed(panels[0].unit, largest)
        axes.set_xlim(self._span)
        axes.set_ylim(low, high)
        few = 2 if box.height < 0.8 else 4
        axes.yaxis.set_major_locator(MaxNLocator(few, steps=[1, 2, 2.5, 5, 10]) if largest
                                     else FixedLocator([0.0]))
        axes.yaxis.set_major_formatter(_Numbers(scale))
        axes.set_ylabel(_label(panels[0], unit))
        axes.yaxis.set_label_coords(-0.48 / box.width, 0.5)
        axes.tick_params(labelbottom=has_times)
        axes.set_xlabel(self._time_label if has_times else '')
        return axes

    def _draw(self, axes: Axes, panel: Panel, names: list[str], style: dict):
        """Draw curves of a panel, those that it has."""
        columns = round(axes.get_position().width * self._size[0] * self._fineness)
        for name in names:
            if name in panel.curves:
                curve = panel.curves[name]
                axes.plot(*thinned(panel.time, curve, columns), color=_colour(name, names),
                          label=name, marker='.' if len(curve) == 1 else '', **style)


class _Numbers(Formatter):
    """The numbers beside an axis in units of so much, all with as many decimals as one needs."""

    def __init__(self, scale: float):
        self._scale = scale

    def __call__(self, value: float, _=None) -> str:
        """Return the text of a number."""
        return self.format_ticks([value])[0]

    def format_ticks(self, values) -> list[str]:
        """Return the texts of the numbers of an axis."""
        numbers = [float(f'{value / self._scale:.10g}') for value in values]
        texts = [np.format_float_positional(number, trim='-') for number in numbers]
        decimals = max(len(text.partition('.')[2]) for text in texts) if texts else 0
        return [f'{number:.{decimals}f}'.replace('-', '−') for number in numbers]


def _colour(name: str, names: list[str]) -> str:
    """Return the colour of one of several curves."""
    return _COLOURS.get(name) or _OTHERS[names.index(name) % len(_OTHERS)]


def _label(panel: Panel, unit: str) -> str:
    """Return what stands beside an axis."""
    if panel.label == DIFFERENCE:
        return f'{DIFFERENCE} [{unit}]' if unit else DIFFERENCE
    return f'{panel.label}\n' + (f'[{unit}]' if unit else '(quaternion)')
