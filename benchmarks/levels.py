# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Which setting is the cheapest one to reach an error.

A setting that is lucky once proves nothing: one counts only if the next three finer settings of
the same method reach the level, too. The same rule holds for everybody. At the fine end of a
method's settings those that are there must reach it.
"""

import itertools

LEVELS = (1e-3, 1e-6, 1e-9, 1e-12)
FINER = 3


def cheapest(cells, level):
    """Return the Cell that reaches a level in the least time, or None."""
    found = []
    for _, group in itertools.groupby(cells, lambda cell: (cell.peer, cell.setting.method)):
        group = list(group)
        found += [cell for i, cell in enumerate(group)
                  if all(other.error <= level for other in group[i:i + FINER + 1])]
    return min(found, key=lambda cell: cell.seconds, default=None)


def of_peer(cells, name):
    return [cell for cell in cells if cell.peer == name]


def ratio(cells, level, names):
    """Return (ours, best of the named peers, ratio of their times), each may be None."""
    ours = cheapest(of_peer(cells, 'ours'), level)
    best = cheapest([cell for cell in cells if cell.peer in names], level)
    return ours, best, best.seconds / ours.seconds if ours and best else None
