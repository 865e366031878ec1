# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Two runs beside each other: which panels belong together, and how much they differ."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .plot_panels import Block, Panel

DIFFERENCE = 'Δ'


def pair(bands: list[list[Block]], others: list[list[Block]]) -> list[str]:
    """
    Give each panel that of the other run with the same name; return what only one run has.

    Of the two quaternions that an orientation has, the other run gets those that are closer.
    """
    first, second = _by_name(bands), _by_name(others)
    for name, panel in first.items():
        panel.other = second.get(name)
        if panel.other and not panel.unit:
            _, here, there = _common(panel)
            if sum(here[part] @ there[part] for part in here) < 0.0:
                curves = {part: -curve for part, curve in panel.other.curves.items()}
                panel.other = replace(panel.other, curves=curves)
    return [' '.join(name) for name in {**first, **second} if (name in first) != (name in second)]


def difference(panel: Panel) -> Panel:
    """Return the other run's curves less those of a panel, at its times that both runs cover."""
    time, here, there = _common(panel)
    return Panel(DIFFERENCE, panel.unit, time, {name: there[name] - here[name] for name in here})


def _by_name(bands: list[list[Block]]) -> dict[tuple[str, str], Panel]:
    return {(block.heading, panel.label): panel
            for band in bands for block in band for row in block.rows for panel in row}


def _common(panel: Panel) -> tuple[np.ndarray, dict[str, np.ndarray], dict[str, np.ndarray]]:
    """
    Return the times of a panel that both runs cover, and the curves of both at these.

    Between its samples the other run is interpolated linearly.
    """
    other = panel.other
    inside = slice(np.searchsorted(panel.time, other.time[0]),
                   np.searchsorted(panel.time, other.time[-1], side='right'))
    time = panel.time[inside]
    names = [name for name in panel.shown if name in panel.curves and name in other.curves]
    return (time, {name: panel.curves[name][inside] for name in names},
            {name: np.interp(time, other.time, other.curves[name]) for name in names})
