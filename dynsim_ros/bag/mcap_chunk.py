# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The content of an MCAP chunk in progress, with its message indexes."""

from __future__ import annotations

import struct

import numpy as np

from .pack_rows import prepare_packing, RowPlan

# A message's record up to its data, and an entry of a message index.
_HEAD = struct.Struct('<BQHIQQ')
_ENTRY = struct.Struct('<QQ')
_MESSAGE, _MESSAGE_INDEX = 5, 7
_INDEX_HEAD = struct.Struct('<BQHI')


class Chunk:
    """
    Messages one behind the other, until there are `capacity` bytes of them.

    plan: RowPlan of ticks whose rows are added, or None. size: bytes so far; count: messages;
    start_ns, end_ns: first and last log time.
    """

    def __init__(self, capacity: int):
        """Begin with nothing in it."""
        self.capacity = capacity
        self.plan: RowPlan | None = None
        self._data = np.empty(capacity, np.uint8)
        self._index: dict[int, bytearray] = {}
        self._counts = np.zeros(0, np.int64)
        self._row_index = np.zeros((0, 0, 2), np.int64)
        self.size = self.count = self.start_ns = self.end_ns = 0

    def declare_rows(self, plan: RowPlan):
        """Let ticks with such rows be added; once."""
        self.plan = plan
        block = int(plan.end[-1]) if len(plan.end) else 1
        # As many ticks as there is room for, even if each has its largest row only.
        longest = int((plan.end - plan.start).min()) if len(plan.end) else 1
        self._make_room(block)
        self._row_index = np.zeros((len(plan.end), len(self._data) // longest + 1, 2), np.int64)
        self._counts = np.zeros(len(plan.end), np.int64)
        self._pack = prepare_packing()

    def add(self, channel_id: int, stamp_ns: int, data: bytes):
        """Append one message."""
        head = _HEAD.pack(_MESSAGE, _HEAD.size - 9 + len(data), channel_id, 0, stamp_ns, stamp_ns)
        end = self.size + len(head) + len(data)
        self._make_room(end)
        self._data[self.size:end] = np.frombuffer(head + data, np.uint8)
        self._index.setdefault(channel_id, bytearray()).extend(_ENTRY.pack(stamp_ns, self.size))
        self._took(end, stamp_ns, stamp_ns, 1)

    def add_rows(self, blocks: np.ndarray, stamps: np.ndarray) -> tuple[int, int]:
        """
        Append the rows of the first ticks of some, as many as there is room for, one at least.

        blocks: (ticks, bytes) uint8; stamps: (ticks,) [ns]. Returns how many ticks and messages.
        """
        ticks = max((self.capacity - self.size) // max(blocks.shape[1], 1), 1)
        blocks, stamps = blocks[:ticks], stamps[:ticks]
        self._make_room(self.size + blocks.size)
        before = int(self._counts.sum())
        end = self._pack(self.plan, blocks, stamps, self._data, self.size, self._row_index,
                         self._counts)
        messages = int(self._counts.sum()) - before
        if messages:
            self._took(end, int(stamps[0]), int(stamps[-1]), messages)
        return len(blocks), messages

    def content(self) -> memoryview:
        """Return the records; valid until more is added."""
        return memoryview(self._data)[:self.size]

    def indexes(self) -> dict[int, bytes]:
        """Return {channel: its message index, a whole record}, for channels with messages."""
        entries = {channel: bytes(index) for channel, index in self._index.items()}
        for r in np.flatnonzero(self._counts):
            channel = int(self.plan.channel[r])
            rows = self._row_index[r, :self._counts[r]].tobytes()
            entries[channel] = rows + entries.get(channel, b'')
        return {channel: _INDEX_HEAD.pack(_MESSAGE_INDEX, 6 + len(index), channel, len(index))
                + index for channel, index in entries.items()}

    def clear(self):
        """Begin anew."""
        self._index.clear()
        self._counts[:] = 0
        self.size = self.count = 0

    def _took(self, end, start_ns, end_ns, messages):
        if self.count == 0:
            self.start_ns = start_ns
        self.end_ns = end_ns
        self.count += messages
        self.size = end

    def _make_room(self, size):
        if size > len(self._data):
            grown = np.empty(size, np.uint8)
            grown[:self.size] = self._data[:self.size]
            self._data = grown
