# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Where everything stands in the messages of a topic, as numpy reads it without a copy."""

from __future__ import annotations

from collections.abc import Callable
import struct
from typing import NamedTuple

import numpy as np

from .definitions import Field
from .primitives import byte_order, code, LITTLE_ENDIAN

HEADER_SIZE = len(LITTLE_ENDIAN)


class Length(NamedTuple):
    """The length of a string or sequence: its first byte, its value, the name of the field."""

    start: int
    count: int
    field: str


class MessageLayout(NamedTuple):
    """
    The layout of a message and of all that have strings and sequences of the same lengths.

    dtype: nested as the message is, its size a multiple of 8; size: bytes of the message; both,
    and all places, behind the 4-byte header. order: '<' or '>'; lengths: what has to be the same.
    """

    dtype: np.dtype
    size: int
    order: str
    lengths: tuple[Length, ...]

    def differing(self, rows: np.ndarray) -> str | None:
        """Return the name of a field whose length differs in some of (n, dtype.itemsize) uint8."""
        for start, count, field in self.lengths:
            found = rows[:, start:start + 4].copy().view(f'{self.order}u4')
            if (found != count).any():
                return field
        return None


def message_layout(type_name: str, data: bytes, fields_of: Callable[[str], tuple[Field, ...]]
                   ) -> MessageLayout:
    """
    Return the layout of one message, CDR bytes; fields_of: as recorded_fields returns it.

    Strings are bytes, sequences of a length are arrays. Where elements of a sequence are laid out
    differently, as strings of several lengths make it, they are fields '0', '1', … instead.
    Raises ValueError for data that end too early or are not plain CDR.
    """
    walk = _Walk(type_name, data, fields_of)
    kind, start = walk.message(type_name, '')
    end = max(start + kind.itemsize, walk.at)
    return MessageLayout(_moved(kind, start, end + -end % 8), walk.at, walk.order,
                         tuple(walk.lengths))


class _Walk:
    """Goes through one message; each method returns the numpy type of a value and its start."""

    def __init__(self, type_name, data, fields_of):
        self.order = byte_order(type_name, data)
        self.at = 0
        self.lengths: list[Length] = []
        self._type_name, self._fields_of = type_name, fields_of
        self._data = memoryview(data)[HEADER_SIZE:]

    def message(self, type_name, path):
        fields = self._fields_of(type_name)
        if not fields:
            # A message without fields is sent as one byte.
            return np.dtype([]), self._take(1, 1, path)
        found = [self._field(field, f'{path}.{field.name}'.lstrip('.')) for field in fields]
        return _structure([field.name for field in fields], found)

    def _field(self, field, path):
        if not field.is_sequence and field.length is None:
            return self._value(field.type_name, path)
        count = self._length(path) if field.is_sequence else field.length
        if count > len(self._data) - self.at:
            # Every value takes a byte or more: a wild count must not fill the memory.
            raise self._too_short(path)
        if '/' in field.type_name or field.type_name == 'string':
            return self._elements(field.type_name, count, path)
        kind = self._number(field.type_name, path)
        start = self._take(count * kind.itemsize, kind.itemsize if count else 1, path)
        return np.dtype((kind, (count,))), start

    def _elements(self, type_name, count, path):
        if not count:
            return np.dtype(([], (0,))), self.at
        return _array([self._value(type_name, f'{path}.{i}') for i in range(count)])

    def _value(self, type_name, path):
        if '/' in type_name:
            return self.message(type_name, path)
        if type_name == 'string':
            size = self._length(path)
            start = self._take(size, 1, path)
            # The zero at its end does not belong to it.
            ends = self._data[start:self.at].tobytes().endswith(b'\0')
            return np.dtype(f'S{size - ends}'), start
        kind = self._number(type_name, path)
        return kind, self._take(kind.itemsize, kind.itemsize, path)

    def _number(self, type_name, path):
        return np.dtype(self.order + code(type_name, path))

    def _length(self, path):
        start = self._take(4, 4, path)
        count, = struct.unpack_from(f'{self.order}I', self._data, start)
        self.lengths.append(Length(start, count, path))
        return count

    def _take(self, size, alignment, path):
        """Go on behind so many bytes; return where they begin."""
        start = self.at + -self.at % alignment
        if start + size > len(self._data):
            raise self._too_short(path)
        self.at = start + size
        return start

    def _too_short(self, path):
        return ValueError(f'{self._type_name}: the data end after '
                          f'{len(self._data) + HEADER_SIZE} bytes, within or before {path}')


def _structure(names, found):
    """Return (type, start) of values one behind the other: [(type, start)]."""
    start = min(place for _, place in found)
    end = max(place + kind.itemsize for kind, place in found)
    return np.dtype({'names': names, 'formats': [kind for kind, _ in found],
                     'offsets': [place - start for _, place in found],
                     'itemsize': end - start}), start


def _array(found):
    """Return (type, start) of the elements of a sequence: [(type, start)], one at least."""
    kind, start = found[0]
    stride = found[1][1] - start if len(found) > 1 else kind.itemsize
    even = all(element == (kind, start + i * stride) for i, element in enumerate(found))
    if not even or stride < kind.itemsize or (stride > kind.itemsize and not kind.names):
        return _structure([str(i) for i in range(len(found))], found)
    if stride > kind.itemsize:
        # The padding up to the next element is part of each.
        kind = _moved(kind, 0, stride)
    return np.dtype((kind, (len(found),))), start


def _moved(kind, start, size):
    """Return a structure with all fields so many bytes further on, in so many bytes."""
    fields = [kind.fields[name] for name in kind.names]
    return np.dtype({'names': kind.names, 'formats': [field[0] for field in fields],
                     'offsets': [start + field[1] for field in fields], 'itemsize': size})
