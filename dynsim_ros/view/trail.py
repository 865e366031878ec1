# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Where a body was: a line that fades with age."""

from __future__ import annotations

import numpy as np

# Of this many points.
_POINTS = 120
_YOUNG, _OLD = np.array([61, 111, 182]), np.array([235, 240, 247])


class Trail:
    """The trail of a body."""

    def __init__(self, api, name, space):
        ages = np.linspace(0.0, 1.0, _POINTS)[:, None]
        colors = _OLD + ages * (_YOUNG - _OLD)
        self._line = api.add_line_segments(
            name, np.zeros((_POINTS - 1, 2, 3)),
            np.stack([colors[:-1], colors[1:]], 1).astype(np.uint8), thickness=2.5,
            thickness_units='screen',
            visible=False)

    def show(self, table, start, end):
        """Draw it from one time to another [s]; table: of poses, or None."""
        first, last = table.between(start, end) if table is not None else (0, 0)
        self._line.visible = last - first > 1
        if not self._line.visible:
            return
        # Rows are picked on a grid of the whole table, so that the line does not crawl.
        stride = -(-(last - first) // (_POINTS - 2))
        rows = np.concatenate([np.arange(-(-first // stride) * stride, last, stride), [last - 1]])
        path = table.values[rows[-_POINTS:], :3]
        # Shorter ones begin with points that lie on one another.
        path = np.concatenate([np.repeat(path[:1], _POINTS - len(path), axis=0), path])
        self._line.points = np.stack([path[:-1], path[1:]], 1)
