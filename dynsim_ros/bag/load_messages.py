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


def indexed(data: np.ndarray, indexes: list[tuple[int, bytes]]) -> Found | None:
    """
    Return the messages among the records of chunks as their indexes tell, in order.

    data: (n,) uint8, the records of chunk after chunk; indexes: (where a chunk begins, its
    message index records). None where a walk from record to record would find anything else.
    """
    try:
        places = [place for base, index in indexes for place in _places(base, index)]
    except DamagedChunk:
        return None
    starts = np.sort(np.concatenate([np.zeros(0, np.int64), *places]))
    if not len(starts) or starts[0] < 0 or starts[-1] > len(data) - _RECORD.itemsize:
        return None
    heads = _heads(data, starts)
    lengths = heads['length'].copy()
    if ((heads['opcode'] != Opcode.MESSAGE).any() or lengths.min() < MESSAGE.size
            or lengths.max() > len(data)):
        return None
    # From the end of a message to the start of the next one there may be other records only, and
    # none from chunk to chunk.
    ends = np.concatenate([[0], starts + (HEAD.size + lengths)])
    nexts = np.concatenate([starts, [len(data)]])
    if (ends > nexts).any():
        return None
    bases = np.array([base for base, _ in indexes])
    if (ends[np.searchsorted(ends[:-1], bases)] != bases).any():
        return None
    if any(_hides_messages(data[ends[gap]:nexts[gap]]) for gap in np.flatnonzero(ends < nexts)):
        return None
    return _found(starts, heads)


def walked(records: list[bytes]) -> tuple[Found, list[bool]]:
    """Return the messages among the records of chunks, and of each chunk whether all fit."""
    # Imported here: hardly a bag needs the compiled code, which takes a second to load.
    from .chunk_records import records_of

    starts, fit, base = [np.zeros(0, np.int64)], [], 0
    for chunk in records:
        found = records_of(chunk)
        starts.append(np.array(found.starts(), np.int64) + base)
        fit.append(found.end == len(chunk))
        base += len(chunk)
    starts = np.concatenate(starts)
    return _found(starts, _heads(np.frombuffer(b''.join(records), np.uint8), starts)), fit


def _places(base, index):
    """Yield (n,) places of messages of each channel, from where the chunk begins."""
    for opcode, start, end in parts(index):
        if opcode == Opcode.MESSAGE_INDEX and (end - start) % _ENTRY == _CHANNEL_AND_SIZE:
            yield np.frombuffer(index[start + _CHANNEL_AND_SIZE:end], '<i8')[1::2] + base


def _hides_messages(data):
    """Tell whether there are messages among records, or what is no record."""
    try:
        return any(opcode in (0, Opcode.MESSAGE) for opcode, _, _ in parts(data.tobytes()))
    except DamagedChunk:
        return True


def _heads(data, starts):
    """Return the records that begin at some places up to their data: (n,) of _RECORD."""
    size = _RECORD.itemsize
    # As plain bytes: numpy copies structures field by field.
    windows = np.ndarray((max(len(data) - size + 1, 0),), f'V{size}', data, strides=(1,))
    return windows[starts].view(_RECORD)


def _found(starts, heads):
    channel, length, log_ns = (heads[name].copy() for name in ('channel', 'length', 'log_ns'))
    return Found(channel, starts + _RECORD.itemsize, length - MESSAGE.size, log_ns)
