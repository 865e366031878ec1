# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Primitive types of ROS messages on the wire: XCDR1, everything aligned to its own size."""

import struct

# Four bytes before every message; alignment counts from behind them.
LITTLE_ENDIAN = b'\x00\x01\x00\x00'
BIG_ENDIAN = b'\x00\x00\x00\x00'

CODES = {
    'bool': '?', 'byte': 'B', 'char': 'B', 'int8': 'b', 'uint8': 'B', 'int16': 'h', 'uint16': 'H',
    'int32': 'i', 'uint32': 'I', 'int64': 'q', 'uint64': 'Q', 'float32': 'f', 'float64': 'd',
}
BYTE_TYPES = ('byte', 'char', 'uint8')
SIZES = {name: struct.calcsize('<' + code) for name, code in CODES.items()}


def number_bytes(type_name, values, path):
    """Return numbers of one primitive type as bytes, without padding before them."""
    if type_name in BYTE_TYPES:
        # rclpy gives a `byte` as a bytes object of length 1.
        values = [value[0] if isinstance(value, bytes) and len(value) == 1 else value
                  for value in values]
    try:
        return struct.pack(f'<{len(values)}{code(type_name, path)}', *values)
    except (struct.error, TypeError, OverflowError) as error:
        shown = values[0] if len(values) == 1 else list(values)
        raise ValueError(f'{path}: {shown!r} does not fit {type_name}: {error}') from None


def string_bytes(value, path):
    """Return a string as bytes: its length, its UTF-8, a zero; to be aligned to 4."""
    if not isinstance(value, str):
        raise ValueError(f'{path}: {value!r} is not a string')
    data = value.encode() + b'\0'
    return struct.pack('<I', len(data)) + data


def code(type_name, path):
    """Return the letter that the struct module has for a primitive type."""
    try:
        return CODES[type_name]
    except KeyError:
        raise ValueError(f'{path}: type {type_name} is not supported') from None


def byte_order(type_name, data):
    """Return '<' or '>', as CDR bytes tell by their header; raise ValueError for other bytes."""
    if data[:2] not in (LITTLE_ENDIAN[:2], BIG_ENDIAN[:2]) or len(data) < len(LITTLE_ENDIAN):
        raise ValueError(f'{type_name}: the data are not plain CDR, they begin with '
                         f'{bytes(data[:4]).hex(" ") or "nothing"}')
    return '<' if data[1] else '>'
