# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Curves thinned to what can be seen of them."""

from __future__ import annotations

import numpy as np


def thinned(time: np.ndarray, values: np.ndarray, columns: int) -> tuple[np.ndarray, np.ndarray]:
    """
    Return the samples that make the same picture in so many columns of pixels.

    Of each column that is the first and the last sample, the lowest and the highest. time: (n,),
    nowhere decreasing; values: (n,). What has few samples is returned as it is.
    """
    if len(time) <= 4 * columns:
        return time, values
    share = (time - time[0]) / ((time[-1] - time[0]) or 1.0)
    column = np.minimum((share * columns).astype(np.int64), columns - 1)
    starts = np.flatnonzero(np.diff(column, prepend=-1))
    ends = np.append(starts[1:], len(time))
    kept = [starts, ends - 1]
    for extreme in (np.fmin, np.fmax):
        reached = values == np.repeat(extreme.reduceat(values, starts), ends - starts)
        places = np.flatnonzero(reached)
        # The first in each column.
        kept.append(places[np.diff(column[places], prepend=-1) != 0])
    chosen = np.unique(np.concatenate(kept))
    return time[chosen], values[chosen]
