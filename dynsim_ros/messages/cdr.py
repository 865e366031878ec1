# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Any ROS message as CDR bytes and back, without rclpy.

Messages are nested dicts: `{'header': {'frame_id': 'world'}, 'point': {'x': 1.0}}`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
import struct

from .checks import check_elements, fields_for
from .definitions import Field, installed_fields
from .primitives import (
    byte_order,
    BYTE_TYPES,
    code,
    LITTLE_ENDIAN,
    number_bytes,
    SIZES,
    string_bytes,
)
from .template import Template

__all__ = ['Template', 'decode', 'encode']


def encode(type_name: str, value: Mapping | None = None) -> bytes:
    """
    Return a message as little-endian CDR with its 4-byte header, as `Publisher.publish` takes it.

    Fields that `value` lacks take the default of the definition, else zero, '' or an empty
    sequence. Raises ValueError that names the field for an unknown field or a value that does
    not fit, MessageDefinitionError for an unknown type.
    """
    out = bytearray(LITTLE_ENDIAN)
    _put_message(out, type_name, {} if value is None else value, type_name)
    return bytes(out)


def decode(type_name: str, data: bytes,
           fields_of: Callable[[str], tuple[Field, ...]] = installed_fields) -> dict:
    """
    Return the message that CDR bytes of either byte order hold, every field present.

    fields_of: as recorded_fields returns it, for types as a bag describes them. Sequences and
    arrays of bytes are `bytes`, other ones lists; a `byte` is an int. Raises ValueError for data
    that end too early or are not plain CDR.
    """
    return _Reader(type_name, data, fields_of).message(type_name, type_name)


def _put_message(out: bytearray, type_name: str, value: Mapping, path: str):
    """Append a message's fields in order."""
    fields = fields_for(type_name, value, path)
    if not fields:
        # A message without fields is sent as one byte.
        out.append(0)
    for field in fields:
        _put_field(out, field, value.get(field.name, field.default), f'{path}.{field.name}')


def _put_field(out: bytearray, field: Field, value, path: str):
    """Append one field: a single value, a fixed array or a sequence."""
    if not field.is_sequence and field.length is None:
        _put_elements(out, field.type_name, [_zero(field) if value is None else value], path)
        return
    if value is None:
        value = [_zero(field)] * (field.length or 0)
    check_elements(field, value, path)
    if field.is_sequence:
        _align(out, 4)
        out += struct.pack('<I', len(value))
    _put_elements(out, field.type_name, value, path)


def _put_elements(out: bytearray, type_name: str, values, path: str):
    """Append values of one type, one behind the other."""
    if '/' in type_name:
        for value in values:
            _put_message(out, type_name, value, path)
    elif type_name == 'string':
        for value in values:
            _align(out, 4)
            out += string_bytes(value, path)
    elif len(values):
        data = number_bytes(type_name, values, path)
        _align(out, SIZES[type_name])
        out += data


def _align(out: bytearray, size: int):
    """Pad with zeros to a multiple of size behind the 4-byte header."""
    out += bytes(-(len(out) - 4) % size)


def _zero(field: Field):
    """Return what an element of a field is when nothing is given."""
    if field.is_message:
        return {}
    return '' if field.type_name == 'string' else 0


class _Reader:
    """Reads the values of one message one behind the other."""

    def __init__(self, type_name: str, data: bytes, fields_of):
        """Check the header and note the byte order."""
        self._order = byte_order(type_name, data)
        self._fields_of = fields_of
        self._type_name = type_name
        self._data = memoryview(data)[4:]
        self._at = 0

    def message(self, type_name: str, path: str) -> dict:
        """Return the next message as a dict."""
        fields = self._fields_of(type_name)
        if not fields:
            self._take(1, 1, path)
        return {field.name: self._field(field, f'{path}.{field.name}') for field in fields}

    def _field(self, field: Field, path: str):
        """Return the next field's value."""
        if not field.is_sequence and field.length is None:
            return self._elements(field.type_name, 1, path)[0]
        count = self._number('uint32', path) if field.is_sequence else field.length
        values = self._elements(field.type_name, count, path)
        return bytes(values) if field.type_name in BYTE_TYPES else values

    def _elements(self, type_name: str, count: int, path: str) -> list:
        """Return the next `count` values of one type."""
        if count > len(self._data) - self._at:
            # Every value takes a byte or more: a wild count must not fill the memory.
            raise self._too_short(path)
        if '/' in type_name:
            return [self.message(type_name, path) for _ in range(count)]
        if type_name == 'string':
            return [self._string(path) for _ in range(count)]
        letter = code(type_name, path)
        if not count:
            return []
        raw = self._take(SIZES[type_name] * count, SIZES[type_name], path)
        return list(struct.unpack(f'{self._order}{count}{letter}', raw))

    def _number(self, type_name: str, path: str):
        """Return the next number."""
        return self._elements(type_name, 1, path)[0]

    def _string(self, path: str) -> str:
        """Return the next string."""
        raw = bytes(self._take(self._number('uint32', path), 1, path))
        try:
            return raw.removesuffix(b'\0').decode()
        except UnicodeDecodeError:
            raise ValueError(f'{path}: {raw!r} is not UTF-8') from None

    def _take(self, size: int, alignment: int, path: str) -> memoryview:
        """Return the next bytes behind the padding."""
        start = self._at + -self._at % alignment
        if start + size > len(self._data):
            raise self._too_short(path)
        self._at = start + size
        return self._data[start:self._at]

    def _too_short(self, path: str) -> ValueError:
        """Return the error for data that end before a field."""
        return ValueError(f'{self._type_name}: the data end after {len(self._data) + 4} bytes, '
                          f'within or before {path}')
