# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The content of an MCAP chunk in progress, with its message indexes."""

from __future__ import annotations

import struct

import numpy as np

from .pack_rows import prepare_packing, RowPlan
from .summary import message_index

# A message's record up to its data, and an entry of a message index.
_HEAD = struct.Struct('<BQHIQQ')
_ENTRY = struct.Struct('<QQ')
_MESSAGE = 5


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
        self._channels: list[int] = []
        self.size = self.count = self.start_ns = self.end_ns = 0

    def declare_rows(self, plan: RowPlan):
        """Let ticks with such rows be added; once."""
        self.plan = plan
        block = int(plan.end[-1]) if len(plan.end) else 1
        # As many ticks as there is room for, even if each has its largest row only.
        longest = int((plan.end - plan.start).min()) if len(plan.end) else 1
        # A chunk is full when it has reached its capacity, not before.
        self._make_room(self.capacity + block)
        self._row_index = np.zeros((len(plan.end), len(self._data) // longest + 1, 2), np.int64)
        self._counts = np.zeros(len(plan.end), np.int64)
        self._channels = plan.channel.tolist()
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
        before = sum(self._counts.tolist())
        end = self._pack(self.plan, blocks, stamps, self._data, self.size, self._row_index,
                         self._counts)
        messages = sum(self._counts.tolist()) - before
        if messages:
            self._took(end, int(stamps[0]), int(stamps[-1]), messages)
        return len(blocks), messages

    def content(self) -> memoryview:
        """Return the records; valid until more is added."""
        return memoryview(self._data)[:self.size]

    def indexes(self) -> dict[int, bytes]:
        """Return {channel: its message index, a whole record}, for channels with messages."""
        entries = {channel: bytes(index) for channel, index in self._index.items()}
        for channel, count, index in zip(self._channels, self._counts.tolist(), self._row_index,
                                         strict=True):
            if count:
                entries[channel] = index[:count].tobytes() + entries.get(channel, b'')
        return {channel: message_index(channel, index) for channel, index in entries.items()}

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
