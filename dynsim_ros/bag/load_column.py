# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The messages of one topic, gathered into a structured array."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import zstandard

from .reader import Channel
from .sources import Source
from ..messages.message_layout import HEADER_SIZE, message_layout
from ..messages.recorded_types import recorded_fields

# A row may be read with up to so many bytes behind its message.
SLACK = 1024


class _Irregular(ValueError):
    """Messages that are not laid out alike; how they differ."""

    def __init__(self, how):
        super().__init__(f'{how}, get them one by one by messages()')


class Rows(NamedTuple):
    """The messages of a topic in order of time: log times (n,) int64 [ns], values (n,)."""

    time_ns: np.ndarray
    values: np.ndarray


class Column:
    """
    Gathers the messages of a topic, all laid out as the first one.

    left_out: None, or one line that says why they cannot be rows; irregular: whether that is
    because they are not laid out alike.
    """

    def __init__(self, channel: Channel):
        self.left_out: str | None = None
        self.irregular = False
        self._channel = channel
        self._head, self._layout = b'', None
        self._parts: list[np.ndarray] = []
        self._times: list[np.ndarray] = []
        if channel.encoding != 'cdr':
            self.left_out = f"they are '{channel.encoding}', not CDR"

    def add(self, source: Source, data, start, size, log_ns):
        """Take in messages: (n,) where each begins in `data`, its size, its log time [ns]."""
        if self.left_out:
            return
        try:
            if source.unpack:
                data, start, size = _unpacked(source, data, start, size)
            self._parts.append(self._gathered(data, start, size))
            self._times.append(log_ns)
        except (ValueError, zstandard.ZstdError) as error:
            self.left_out, self.irregular = str(error), isinstance(error, _Irregular)
            self._parts, self._times = [], []

    def rows(self) -> Rows | None:
        """Return what was gathered, in order of time; messages of one time keep theirs."""
        if not self._parts:
            return None
        times, parts = np.concatenate(self._times), np.concatenate(self._parts)
        self._parts, self._times = [], []
        values = parts.view(self._layout.dtype)[:, 0]
        if (np.diff(times) < 0).any():
            order = np.argsort(times, kind='stable')
            times, values = times[order], values[order]
        return Rows(times, values)

    def _gathered(self, data, start, size) -> np.ndarray:
        """Return the messages without their headers, (n, size of the dtype) uint8."""
        if self._layout is None:
            self._begin(data[start[0]:start[0] + size[0]].tobytes())
        if (size < HEADER_SIZE + self._layout.size).any():
            raise _Irregular(f'they have {min(size)} to {max(size)} bytes')
        if any((data[start + i] != byte).any() for i, byte in enumerate(self._head)):
            raise _Irregular('they are encoded in several ways')
        width = self._layout.dtype.itemsize
        windows = np.ndarray((len(data) - width + 1,), f'V{width}', data, strides=(1,))
        rows = windows[start + HEADER_SIZE].view(np.uint8).reshape(-1, width)
        differing = self._layout.differing(rows)
        if differing:
            raise _Irregular(f"the length of '{differing}' varies")
        return rows

    def _begin(self, message: bytes):
        """Lay all messages out as this one."""
        channel = self._channel
        fields_of = recorded_fields(channel.type_name, channel.definition)
        self._layout = message_layout(channel.type_name, message, fields_of)
        self._head = message[:2]


def _unpacked(source: Source, data, start, size):
    """Return data, start and size of messages that rosbag2 compressed one by one."""
    messages = [source.unpack(data[at:at + count].tobytes())
                for at, count in zip(start.tolist(), size.tolist())]
    size = np.array([len(message) for message in messages])
    return (np.frombuffer(b''.join([*messages, bytes(SLACK)]), np.uint8),
            np.cumsum(size) - size, size)
