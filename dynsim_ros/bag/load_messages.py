# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Where the messages among the records of a chunk lie: its message index tells, if it is right."""

from __future__ import annotations

from typing import NamedTuple

from mcap.opcode import Opcode
import numpy as np

from .records import DamagedChunk, HEAD, MESSAGE, parts

# A message's record up to its data, see records.HEAD and records.MESSAGE.
_RECORD = np.dtype([('opcode', 'u1'), ('length', '<i8'), ('channel', '<u2'), ('sequence', '<u4'),
                    ('log_ns', '<i8'), ('publish_ns', '<i8')])
# A message index before its entries, each of which is a log time and a place.
_CHANNEL_AND_SIZE, _ENTRY = 6, 16


class Found(NamedTuple):
    """Messages, (n,) each: channel, first byte of the CDR data, their size, log time [ns]."""

    channel: np.ndarray
    start: np.ndarray
    size: np.ndarray
    log_ns: np.ndarray

    def moved(self, by: int) -> Found:
        """Return them so many bytes further on."""
        return self._replace(start=self.start + by)


def find_messages(records: bytes, index: bytes) -> tuple[Found, bool]:
    """
    Return the messages among records in their order, and whether all records fit.

    index: the message index records of their chunk, b'' for none. Whatever it says, what is found
    is what a walk from record to record finds.
    """
    data = np.frombuffer(records, np.uint8)
    starts = _indexed(data, index)
    if starts is not None:
        return _found(data, starts), True
    # Imported here: hardly a bag needs the compiled code, which takes a second to load.
    from .chunk_records import records_of

    walked = records_of(records)
    return _found(data, np.array(walked.starts(), np.int64)), walked.end == len(records)


def _indexed(data, index):
    """Return where the messages begin, ascending (n,); None if the index does not tell it."""
    try:
        places = [np.frombuffer(index[start + _CHANNEL_AND_SIZE:end], '<i8')[1::2]
                  for opcode, start, end in parts(index)
                  if opcode == Opcode.MESSAGE_INDEX and not (end - start - _CHANNEL_AND_SIZE)
                  % _ENTRY]
    except DamagedChunk:
        return None
    starts = np.sort(np.concatenate([np.zeros(0, np.int64), *places]))
    if not len(starts) or starts[0] < 0 or starts[-1] > len(data) - _RECORD.itemsize:
        return None
    heads = _heads(data, starts)
    lengths = heads['length']
    if ((heads['opcode'] != Opcode.MESSAGE) | (lengths < MESSAGE.size)
            | (lengths > len(data))).any():
        return None
    # From the end of a message to the start of the next one there may be other records only.
    ends = np.concatenate([[0], starts + HEAD.size + lengths])
    nexts = np.concatenate([starts, [len(data)]])
    if (ends > nexts).any() or any(_hides_messages(data[ends[gap]:nexts[gap]])
                                   for gap in np.flatnonzero(ends < nexts)):
        return None
    return starts


def _hides_messages(data):
    """Tell whether there are messages among records, or what is no record."""
    try:
        return any(opcode in (0, Opcode.MESSAGE) for opcode, _, _ in parts(data.tobytes()))
    except DamagedChunk:
        return True


def _heads(data, starts):
    """Return the records that begin at some places up to their data: (n,) of _RECORD."""
    if not len(starts):
        return np.zeros(0, _RECORD)
    windows = np.ndarray((len(data) - _RECORD.itemsize + 1,), _RECORD, data, strides=(1,))
    return windows[starts]


def _found(data, starts):
    heads = _heads(data, starts)
    return Found(heads['channel'], starts + _RECORD.itemsize, heads['length'] - MESSAGE.size,
                 heads['log_ns'])
