# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The messages of a tick as rows of one block of bytes, as they are published and recorded."""

from __future__ import annotations

from collections.abc import Iterable
import struct
from typing import NamedTuple

import numpy as np

from .channel import Channel
from .row import STAMP
from ..simulation.layout import Layout
from ..simulation.rows.kernel import HEAD_SIZE, Instants, prepare_rows, RowTable
from ..simulation.rows.tick_numbers import Numbers

# What a row begins with, see rows.kernel: a record of an MCAP file up to its data.
_HEAD = struct.Struct('<BQHIQQ')
assert _HEAD.size == HEAD_SIZE


class Wanted(NamedTuple):
    """Which rows are wanted, by number and as (rows,) bool, and what they need; see TickRows."""

    numbers: tuple
    mask: np.ndarray
    with_forces: bool
    with_energies: bool


class TickRows:
    """
    All messages of fixed size of a tick, one behind the other in a block of bytes.

    channels: those Channels of a list that have a row, in their order; table: RowTable; size:
    bytes of a block; block: (size,) uint8, that of the instant filled in last; view: its memory;
    blocks: (instants, size), the first of those in `reserved`. Each message is padded to a
    multiple of four, as DDS does it, and stands behind the head of its record in a bag. To use it:
    wanted = rows.of(channels), once; at every tick rows.fill(simulator.instant(), stamp_ns,
    wanted) and, of each row number i in wanted.numbers, publisher.publish(rows.message(i)).
    """

    def __init__(self, channels, layout: Layout, reserve: int = 1):
        """
        Lay out the rows of channels; layout: that of the scene whose channels they are.

        reserve: as long as no more instants are filled in at a time, blocks stay where they are.
        """
        self.channels = [channel for channel in channels if channel.row is not None]
        rows = [channel.row for channel in self.channels]
        sizes = [HEAD_SIZE + _padded(row.template.size) for row in rows]
        starts = np.concatenate([[0], np.cumsum(sizes, dtype=np.int64)])
        self.size = int(starts[-1])
        self.table = _table(rows, starts[:-1])
        self.spans = [(int(start) + HEAD_SIZE, int(end))
                      for start, end in zip(starts[:-1], starts[1:])]
        self._blank = np.frombuffer(b''.join(map(_blank, rows)), np.uint8)
        self._numbers = Numbers(layout)
        self._arrays = self._numbers.arrays()
        self._wanted: dict[tuple, Wanted] = {}
        self.reserved = self.new_blocks(reserve)
        self._use(self.reserved[:1])
        self._kernel, self._model = None, None

    def new_blocks(self, count: int) -> np.ndarray:
        """Return blocks for so many instants, with all that never changes: (count, size)."""
        return np.tile(self._blank, (count, 1))

    def of(self, channels: Iterable[Channel] | None = None) -> Wanted:
        """Return what `fill` is to build: the rows of some of `channels`, None for all."""
        topics = {channel.topic for channel in (self.channels if channels is None else channels)}
        numbers = tuple(i for i, channel in enumerate(self.channels) if channel.topic in topics)
        if numbers not in self._wanted:
            mask = np.zeros(len(self.channels), bool)
            mask[list(numbers)] = True
            places = [place for i in numbers for place in self.channels[i].row.numbers.values()]
            self._wanted[numbers] = Wanted(numbers, mask, any(map(self._numbers.is_force, places)),
                                           any(map(self._numbers.is_energy, places)))
        return self._wanted[numbers]

    def fill(self, instants: Instants, stamp_ns: int, wanted: Wanted):
        """
        Write the wanted messages of an instant, or of the last of several, to `block`.

        instants: as Simulator.instant() returns it; stamp_ns: of the first one. Of several, all
        blocks are in `blocks`.
        """
        count = len(instants.states)
        if count > len(self.reserved):
            self.reserved = self.new_blocks(count)
        if instants.model is not self._model:
            self._choose(instants)
        self._kernel(instants, stamp_ns, wanted.mask, wanted.with_forces, wanted.with_energies,
                     self.table, self._arrays, self.reserved)
        if count != len(self.blocks):
            self._use(self.reserved[:count])

    def message(self, i: int) -> bytes:
        """Return the message of row i of `block`, as CDR bytes."""
        return self._views[i].tobytes()

    def _choose(self, instants):
        """Take the kernel that is compiled for the kind of model."""
        self._kernel = prepare_rows(instants)
        self._model = instants.model

    def _use(self, blocks):
        self.blocks = blocks
        self.block = blocks[-1]
        self.view = memoryview(self.block)
        self._views = [self.view[start:end] for start, end in self.spans]


def _padded(size):
    return size + -size % 4


def _blank(row):
    """Return a row with all numbers zero."""
    data = row.template.content + bytes(-row.template.size % 4)
    return _HEAD.pack(0, _HEAD.size - 9 + len(data), 0, 0, 0, 0) + data


def _table(rows, starts):
    """Return the RowTable of rows that begin at given bytes of a block."""
    stamp, place, number, first = [], [], [], [0]
    for row, start in zip(rows, starts + HEAD_SIZE):
        places = row.template.places
        stamp.append([start + places[leaf].start if leaf in places else -1
                      for leaf in STAMP])
        place += [start + places[leaf].start for leaf in row.numbers]
        number += row.numbers.values()
        first.append(len(place))
    return RowTable(starts, np.array(stamp, np.int64).reshape(-1, 2),
                    *(np.array(part, np.int64) for part in (first, place, number)))
