# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A message of one fixed size, ready to be filled with numbers and sent, many times a second."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
import struct
from typing import NamedTuple

import numpy as np

from .checks import check_elements, fields_for
from .definitions import Field
from .primitives import code, LITTLE_ENDIAN, number_bytes, SIZES, string_bytes


class Place(NamedTuple):
    """Where a leaf of a message stands: its first byte, and its code in the struct module."""

    start: int
    code: str


class Template:
    """
    A message type with some values fixed; the other numbers are filled in.

    fixed: nested dict of what stays the same: strings (those not given are ''), the sequences
    (each has to be given, its length stays), and any numbers. leaves: dotted names of all other
    numbers in wire order, such as 'header.stamp.sec' or 'pose.position.x'; places: {leaf: Place}.
    size: of the message in bytes, with the 4-byte header; content: its bytes, all leaves zero;
    padding: indices of the bytes that mean nothing. blocks: names of sequences of points that are
    one leaf each, given as the bytes of their float64.
    """

    def __init__(self, type_name: str, fixed: Mapping | None = None,
                 blocks: Collection[str] = frozenset()):
        """Lay the message out; raises ValueError naming the field where it has no fixed size."""
        self.type_name = type_name
        self.places: dict[str, Place] = {}
        content, padding = bytearray(LITTLE_ENDIAN), []
        for leaf, alignment, item in _items(type_name, fixed or {}, type_name, ''):
            start = len(content) + (len(LITTLE_ENDIAN) - len(content)) % alignment
            padding += range(len(content), start)
            content += bytes(start - len(content))
            if isinstance(item, bytes):
                content += item
                continue
            self._place(leaf, start, item, blocks)
            content += bytes(alignment)
        self.leaves = tuple(self.places)
        self.size = len(content)
        self.content = bytes(content)
        self.padding = tuple(padding)
        self._pack = struct.Struct(layout(self.places.values(), self.size)).pack
        self._constant = np.frombuffer(self.content, np.uint8)

    def _place(self, leaf, start, item, blocks):
        """Take note of a leaf, or that it is the next number of a block."""
        # As in 'markers.2.points.66.x'.
        block, *_ = leaf.rsplit('.', 2)
        if block not in blocks:
            self.places[leaf] = Place(start, item)
            return
        assert item == 'd', f'{leaf} is no float64'
        first = self.places[block].start if block in self.places else start
        size = start + SIZES['float64'] - first
        self.places[block] = Place(first, f'{size}s')

    def pack(self, *values) -> bytes:
        """
        Return the message as CDR bytes; values: one for each of `leaves`, in order.

        Raises ValueError for a wrong count or a value that does not fit its type.
        """
        try:
            numbers = self._pack(*values)
        except (struct.error, OverflowError) as error:
            if len(values) != len(self.leaves):
                raise ValueError(f'{self.type_name}: {len(values)} values for {len(self.leaves)} '
                                 f'leaves ({", ".join(self.leaves)})') from None
            raise ValueError(f'{self.type_name}: {values} does not fit: {error}') from None
        # Each of the two is zero where the other one is not.
        return (np.frombuffer(numbers, np.uint8) | self._constant).tobytes()


def layout(places, size):
    """Return the format of the struct module for leaves at some Places and zeros between them."""
    parts, end = ['<'], 0
    for start, item in places:
        parts.append(f'{start - end}x{item}')
        end = start + struct.calcsize(f'<{item}')
    return f'{"".join(parts)}{size - end}x'


def _items(type_name: str, fixed, where: str, prefix: str) -> Iterator[tuple]:
    """Yield (leaf name, alignment, constant bytes or struct letter) in wire order."""
    fields = fields_for(type_name, fixed, where)
    if not fields:
        yield prefix, 1, b'\0'
    for field in fields:
        path, value = f'{where}.{field.name}', fixed.get(field.name)
        if value is None and field.type_name == 'string':
            value = field.default
        if not field.is_sequence and field.length is None:
            yield from _item(field.type_name, value, path, prefix + field.name)
        else:
            yield from _array(field, value, path, prefix + field.name)


def _array(field: Field, value, where: str, name: str) -> Iterator[tuple]:
    """Yield the items of a fixed array, or of a sequence whose elements are given."""
    if value is None and field.is_sequence:
        raise ValueError(f'{where} is a sequence, so {field.type_name}[] has no fixed size: give '
                         'its elements, or use encode()')
    elements = [None] * field.length if value is None else value
    check_elements(field, elements, where)
    if field.is_sequence:
        yield name, 4, struct.pack('<I', len(elements))
    for index, element in enumerate(elements):
        yield from _item(field.type_name, element, where, f'{name}.{index}')


def _item(type_name: str, value, where: str, name: str) -> Iterator[tuple]:
    """Yield the items of one value."""
    if '/' in type_name:
        yield from _items(type_name, {} if value is None else value, where, f'{name}.')
    elif type_name == 'string':
        yield name, 4, string_bytes('' if value is None else value, where)
    elif value is None:
        yield name, SIZES.get(type_name, 1), code(type_name, where)
    else:
        yield name, SIZES.get(type_name, 1), number_bytes(type_name, [value], where)
