# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Where panels lie on a figure: all in inches from its upper left corner."""

from __future__ import annotations

from typing import NamedTuple

from .plot_panels import Block, Panel

# Of a page with margins, for two columns; blocks side by side may need twice as much.
_WIDTH, _COLUMNS = 7.2, 2
_TOP, KEY_LINE, _HEADING, _KEY, _HEIGHT, _GAP, _DIFFERENCE, _BELOW = (
    0.35, 0.17, 0.28, 0.34, 1.0, 0.13, 0.5, 0.5)
# What a panel needs for its numbers and the name of its quantity.
LEFT, _RIGHT = 0.82, 0.12


class Box(NamedTuple):
    """A rectangle [inches]: left and upper edge from the upper left corner, width, height."""

    left: float
    top: float
    width: float
    height: float


class Place(NamedTuple):
    """A panel and where it is drawn; where its difference is; whether the times go below it."""

    panel: Panel
    box: Box
    difference: Box | None
    is_lowest: bool


class Sheet:
    """
    Bands of blocks one below the other, the blocks of a band side by side.

    width, height: of the figure [inches]; headings: [(text, left, top)]; places: [Place].
    """

    def __init__(self, bands: list[list[Block]]):
        widest = max((_columns(band) for band in bands if len(band) > 1), default=1)
        self.width = _WIDTH * -(-widest // _COLUMNS)
        self.headings: list[tuple[str, float, float]] = []
        self.places: list[Place] = []
        compares = any(panel.other for band in bands for block in band
                       for row in block.rows for panel in row)
        self.height = _TOP + KEY_LINE * compares
        for band in bands:
            left, ends = 0.0, []
            for block in band:
                width = self.width * block.columns / _columns(band)
                ends.append(self._add(block, left, self.height, width))
                left += width
            self.height = max(ends)

    def _add(self, block: Block, left: float, top: float, width: float) -> float:
        """Place a block; return where it ends."""
        self.headings.append((block.heading, left + LEFT, top))
        top += _HEADING - _GAP
        step = width / block.columns
        for row in block.rows:
            top += _KEY if any(panel.has_key for panel in row) else _GAP
            end = top + _HEIGHT
            for number, panel in enumerate(row):
                at, breadth = left + number * step + LEFT, step - LEFT - _RIGHT
                below = Box(at, end + _GAP / 2, breadth, _DIFFERENCE) if panel.other else None
                self.places.append(Place(panel, Box(at, top, breadth, _HEIGHT), below,
                                         row is block.rows[-1]))
            top = end + _GAP / 2 + _DIFFERENCE if any(panel.other for panel in row) else end
        return top + _BELOW


def _columns(band: list[Block]) -> int:
    return sum(block.columns for block in band)
