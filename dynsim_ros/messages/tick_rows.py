# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The messages of a tick as rows of one block of bytes, as they are published and recorded."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
import struct
from typing import NamedTuple

import numpy as np

from .template import Template
from ..simulation.numbers import Numbers
from ..simulation.row_kernel import HEAD_SIZE, Instants, prepare_rows, RowTable

# What a row begins with, see row_kernel: a record of an MCAP file up to its data.
_HEAD = struct.Struct('<BQHIQQ')
assert _HEAD.size == HEAD_SIZE
_SECONDS, _NANOSECONDS = 'header.stamp.sec', 'header.stamp.nanosec'


@dataclass(frozen=True)
class Row:
    """
    A message of fixed size that a kernel fills in.

    template: its leaves are the stamp, if it has one, and those of `numbers`: {leaf: place of the
    number in Numbers}. Raises ValueError for a leaf that is no float64, or without a number.
    """

    template: Template
    numbers: Mapping[str, int]

    def __post_init__(self):
        """Check that every leaf is known and of the type that the kernel writes."""
        types = dict.fromkeys(self.numbers, 'd')
        if _SECONDS in self.template.places:
            types.update({_SECONDS: 'i', _NANOSECONDS: 'I'})
        found = {leaf: place.code for leaf, place in self.template.places.items()}
        if found != types:
            raise ValueError(f'{self.template.type_name}: its leaves are {found}, but '
                             f'{types} are filled in')


class Wanted(NamedTuple):
    """Which rows are wanted, and what they need; made by TickRows.wanted."""

    mask: np.ndarray
    with_forces: bool
    with_energies: bool
    count: int


class TickRows:
    """
    All messages of fixed size of a tick, one behind the other in a block of bytes.

    channels: those Channels of a list that have a row, in their order; numbers: Numbers;
    table: RowTable; size: bytes of a block; block: (size,) uint8, that of the instant filled in
    last; blocks: (instants, size). Each message is padded to a multiple of four, as DDS does it, and stands behind the head
    of its record in a bag. Use: `rows.fill(simulator.instant(), stamp_ns, wanted)`, then
    `publisher.publish(rows.message(i))` and `bag.put_rows(rows, wanted)`.
    """

    def __init__(self, channels, numbers: Numbers):
        """Lay out the rows of channels; numbers: those of the scene that the channels are of."""
        self.channels = [channel for channel in channels if channel.row is not None]
        self.numbers = numbers
        rows = [channel.row for channel in self.channels]
        sizes = [HEAD_SIZE + _padded(row.template.size) for row in rows]
        starts = np.concatenate([[0], np.cumsum(sizes, dtype=np.int64)])
        self.size = int(starts[-1])
        self.table = _table(rows, starts[:-1])
        self.spans = [(int(start) + HEAD_SIZE, int(end))
                      for start, end in zip(starts[:-1], starts[1:])]
        self._blank = np.frombuffer(b''.join(map(_blank, rows)), np.uint8)
        self._arrays = numbers.arrays()
        self._blocks = self.new_blocks(1)
        self._use(self._blocks)
        self._kernel, self._model = None, None

    def new_blocks(self, count: int) -> np.ndarray:
        """Return blocks for so many instants, with all that never changes: (count, size)."""
        return np.tile(self._blank, (count, 1))

    def wanted(self, rows: Iterable[int]) -> Wanted:
        """Return what `fill` is to build: rows, by their number in `channels`."""
        mask = np.zeros(len(self.channels), bool)
        mask[list(rows)] = True
        places = {place for channel, is_wanted in zip(self.channels, mask) if is_wanted
                  for place in channel.row.numbers.values()}
        return Wanted(mask, any(map(self.numbers.is_force, places)),
                      any(map(self.numbers.is_energy, places)), int(mask.sum()))

    def fill(self, instants: Instants, stamp_ns: int, wanted: Wanted):
        """
        Write the wanted messages of an instant, or of the last of several, to `block`.

        instants: as Simulator.instant() returns it; stamp_ns: of the first one. Of several, all
        blocks are in `blocks`.
        """
        count = len(instants.states)
        if count > len(self._blocks):
            self._blocks = self.new_blocks(count)
        if instants.model is not self._model:
            self._choose(instants)
        self._kernel(instants, stamp_ns, wanted.mask, wanted.with_forces, wanted.with_energies,
                     self.table, self._arrays, self._blocks)
        if count != len(self.blocks):
            self._use(self._blocks[:count])

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
        view = memoryview(self.block)
        self._views = [view[start:end] for start, end in self.spans]


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
                      for leaf in (_SECONDS, _NANOSECONDS)])
        place += [start + places[leaf].start for leaf in row.numbers]
        number += row.numbers.values()
        first.append(len(place))
    return RowTable(starts, np.array(stamp, np.int64).reshape(-1, 2),
                    *(np.array(part, np.int64) for part in (first, place, number)))
