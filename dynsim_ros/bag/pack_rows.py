# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The kernel that puts the rows of many ticks together to the content of an MCAP chunk."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..integrators.entry import entry
from ..physics.jit import kernel
from ..simulation.rows.kernel import PRESENT
from ..simulation.rows.unaligned import copy_bytes, put_number

# Where the channel stands in the record of a message.
_CHANNEL = 9


class RowPlan(NamedTuple):
    """Where rows are in a block, and which channels of a bag they are of: (rows,) int64 each."""

    start: np.ndarray
    end: np.ndarray
    channel: np.ndarray


@kernel
def pack_rows(plan, blocks, stamps, data, at, index, counts):
    """
    Append the messages of some ticks to the content of a chunk; return where that then ends.

    plan: RowPlan; blocks: (ticks, bytes) uint8; stamps: (ticks,) int64 [ns]; data: content, which
    ends at `at` and has room; index: (rows, ticks at least, 2) time and place of each message, of
    which counts: (rows,) are there.
    """
    for k in range(blocks.shape[0]):
        for r in range(plan.start.shape[0]):
            start = plan.start[r]
            if blocks[k, start] != PRESENT:
                continue
            size = plan.end[r] - start
            copy_bytes(data, at, blocks[k], start, size)
            put_number(data, at + _CHANNEL, np.int16(plan.channel[r]))
            index[r, counts[r], 0] = stamps[k]
            index[r, counts[r], 1] = at
            counts[r] += 1
            at += size
    return at


def prepare_packing():
    """Compile, or load from the disk cache, the kernel; return it, see entry."""
    one, data = np.zeros(1, np.int64), np.zeros(1, np.uint8)
    return entry(pack_rows, RowPlan(one, one, one), data.reshape(1, 1), one, data, 0,
                 np.zeros((1, 1, 2), np.int64), one)
