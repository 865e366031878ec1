# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The kernel that finds the messages among the records of MCAP chunks."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..integrators.entry import entry
from ..physics.jit import formula, kernel

# A record's opcode and the length of its content; of a message, where channel, log time and data
# stand in the record. See records.HEAD and records.MESSAGE.
_MESSAGE, _HEAD, _CHANNEL, _LOG_TIME, _DATA = 5, 9, 9, 15, 31


class Found(NamedTuple):
    """Messages, (n,) each: channel, first byte of the CDR data, their size, log time [ns]."""

    channel: np.ndarray
    start: np.ndarray
    size: np.ndarray
    log_ns: np.ndarray


def room_for(size: int) -> Found:
    """Return room for all messages that so many bytes can hold."""
    count = size // _DATA
    return Found(np.empty(count, np.int64), np.empty(count, np.int64), np.empty(count, np.int64),
                 np.empty(count, np.int64))


@formula
def _number(data, at, size):
    """Return an unsigned number of so many bytes, little end first."""
    value = np.int64(0)
    for i in range(size):
        value |= np.int64(data[at + i]) << np.int64(8 * i)
    return value


@kernel
def find_messages(data, start, end, found, count):
    """
    Append the messages among the records in data[start:end] to `found`, which holds `count`.

    data: (n,) uint8. Returns how many there are then; where a record does not fit, the negative
    of that, less 1.
    """
    while start < end:
        length = _number(data, start + 1, 8) if start + _HEAD <= end else np.int64(-1)
        if length < 0 or length > end - start - _HEAD:
            return -count - 1
        if data[start] == _MESSAGE:
            if length < _DATA - _HEAD:
                return -count - 1
            found.channel[count] = _number(data, start + _CHANNEL, 2)
            found.start[count] = start + _DATA
            found.size[count] = length - (_DATA - _HEAD)
            found.log_ns[count] = _number(data, start + _LOG_TIME, 8)
            count += 1
        start += _HEAD + length
    return count


def prepare_finding():
    """Compile, or load from the disk cache, the kernel; return it, see entry."""
    return entry(find_messages, np.zeros(0, np.uint8), 0, 0, room_for(0), 0)
