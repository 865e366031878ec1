# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Fewer rows of a table to draw, with all peaks kept."""

import numpy as np


def thinned(values, first, last, columns, buckets=300):
    """
    Return the numbers, ascending, of the rows to draw of those from first up to last.

    values: (n, k); columns: which of the k are drawn. Rows stay as they are: of each of so many
    stretches of equal length they are those where a column is smallest or largest.
    """
    count = last - first
    if count <= 2 * len(columns) * buckets:
        return np.arange(first, last)
    # Stretches differ by a row in length: the shorter ones reach into the next by one.
    starts = first + np.arange(buckets) * count // buckets
    grid = np.minimum(starts[:, None] + np.arange(count // buckets + 1), last - 1)
    picked = [np.array([first, last - 1])]
    for column in columns:
        part = values[:, column][grid]
        picked += [starts + part.argmin(axis=1), starts + part.argmax(axis=1)]
    return np.unique(np.minimum(np.concatenate(picked), last - 1))
