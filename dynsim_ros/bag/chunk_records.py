# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which records an MCAP chunk consists of, and the index of its messages worked out from them."""

from __future__ import annotations

from typing import NamedTuple

from mcap.opcode import Opcode
import numpy as np

from .summary import ENTRY_SIZE, message_index
from ..integrators.entry import entry
from ..physics.jit import formula, kernel

# Opcode and length of the content; of a message, where channel and log time stand in the record,
# and how many bytes its content has at least.
_HEAD, _CHANNEL, _LOG_TIME, _SHORTEST = 9, 9, 15, 22
_MESSAGE = 5
_KIND, _START, _ID, _TIME = range(4)


@formula
def _number(data, at, size):
    """Return an unsigned number of so many bytes, the lowest one first."""
    value = np.int64(0)
    for i in range(size):
        value |= np.int64(data[at + i]) << np.int64(8 * i)
    return value


@kernel
def find_records(data, found):
    """
    Find the records that data: (n,) uint8 consist of, up to one that is not whole.

    found: (records, 4) int64 to be filled, as far as it reaches, with opcode and first byte of
    each, channel and log time of messages. Returns how many there are, and where they end.
    """
    at, count = 0, 0
    while at + _HEAD <= data.shape[0]:
        length = _number(data, at + 1, 8)
        is_message = data[at] == _MESSAGE
        if (data[at] == 0 or length < 0 or length > data.shape[0] - at - _HEAD
                or (is_message and length < _SHORTEST)):
            break
        if count < found.shape[0]:
            found[count, 0] = data[at]
            found[count, 1] = at
            if is_message:
                found[count, 2] = _number(data, at + _CHANNEL, 2)
                found[count, 3] = _number(data, at + _LOG_TIME, 8)
        count += 1
        at += _HEAD + length
    return count, at


def prepare_finding():
    """Compile, or load from the disk cache, the kernel; return it, see entry."""
    return entry(find_records, np.zeros(1, np.uint8), np.zeros((0, 4), np.int64))


class ChunkRecords(NamedTuple):
    """
    The records of a chunk: its messages, (n, 4) as in find_records; first bytes of the others.

    end: where they end.
    """

    messages: np.ndarray
    others: list[int]
    end: int

    @property
    def times(self) -> tuple[int, int]:
        """Return first and last log time [ns]; 0 and 0 where there is no message."""
        if not len(self.messages):
            return 0, 0
        times = np.ascontiguousarray(self.messages[:, _TIME]).view(np.uint64)
        return int(times.min()), int(times.max())

    def between(self, first_ns: int, last_ns: int) -> ChunkRecords:
        """Return them with the messages of some times alone, both included."""
        times = self.messages[:, _TIME].astype(np.uint64)
        return self._replace(messages=self.messages[(times >= first_ns) & (times <= last_ns)])

    def of(self, ids: set[int]) -> ChunkRecords:
        """Return them with the messages of some channels alone."""
        return self._replace(messages=self.messages[np.isin(self.messages[:, _ID], list(ids))])

    def starts(self) -> list[int]:
        """Return the first byte of each message."""
        return self.messages[:, _START].tolist()

    def counts(self) -> dict[int, int]:
        """Return {channel: number of messages}."""
        ids, counts = np.unique(self.messages[:, _ID], return_counts=True)
        return dict(zip(ids.tolist(), counts.tolist(), strict=True))

    def indexes(self) -> dict[int, bytes]:
        """Return {channel: its message index, a whole record}, for channels with messages."""
        messages = self.messages[np.argsort(self.messages[:, _ID], kind='stable')]
        entries = np.ascontiguousarray(messages[:, [_TIME, _START]]).tobytes()
        ids = messages[:, _ID]
        starts = np.flatnonzero(np.diff(ids, prepend=-1)).tolist()
        return {int(ids[start]): message_index(
            int(ids[start]), entries[start * ENTRY_SIZE:end * ENTRY_SIZE])
            for start, end in zip(starts, [*starts[1:], len(ids)])}


def records_of(data: bytes) -> ChunkRecords:
    """Return the records that data consist of, up to one that is not whole."""
    find, array = prepare_finding(), np.frombuffer(data, np.uint8)
    if not len(array):
        return ChunkRecords(np.zeros((0, 4), np.int64), [], 0)
    found = np.zeros((find(array, np.zeros((0, 4), np.int64))[0], 4), np.int64)
    _, end = find(array, found)
    are_messages = found[:, _KIND] == Opcode.MESSAGE
    return ChunkRecords(found[are_messages], found[~are_messages, _START].tolist(), end)
