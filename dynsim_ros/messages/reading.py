# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Some numbers of messages that come in as bytes, without making objects of the messages."""

from __future__ import annotations

from collections.abc import Collection
from functools import reduce
from itertools import groupby
import operator
import struct

from .cdr import decode
from .template import layout, Template


class Reading:
    """
    Reads the same numbers of every message of a type with a header.

    leaves: dotted names of the numbers, in wire order; frame_ids: those of most messages, which
    are not looked at field by field.
    """

    def __init__(self, type_name: str, leaves: Collection[str], frame_ids: Collection[str]):
        """Lay out messages with these frames; raises ValueError where one has no fixed size."""
        self._type_name, self._leaves = type_name, leaves
        self._expected = [_Expected(type_name, leaves, frame_id) for frame_id in frame_ids]

    def __call__(self, data: bytes) -> tuple[str, tuple]:
        """Return (frame, numbers) of CDR bytes; raises ValueError for what is no such message."""
        for expected in self._expected:
            if expected.fits(data):
                return expected.frame_id, expected.numbers(data)
        message = decode(self._type_name, data)
        return message['header']['frame_id'], tuple(
            reduce(operator.getitem, leaf.split('.'), message) for leaf in self._leaves)


class _Expected:
    """Messages with a certain frame; numbers(data): those of one that fits."""

    def __init__(self, type_name, leaves, frame_id):
        template = Template(type_name, {'header': {'frame_id': frame_id}})
        self.frame_id, self._size = frame_id, template.size
        self.numbers = struct.Struct(layout([template.places[leaf] for leaf in leaves],
                                            template.size)).unpack_from
        free = {*template.padding, *(byte for start, item in template.places.values()
                                     for byte in range(start, start + struct.calcsize(item)))}
        fixed = [byte for byte in range(template.size) if byte not in free]
        # Numbers in a row differ from their places in the list by the same.
        stretches = [[byte for _, byte in group] for _, group in groupby(
            enumerate(fixed), lambda pair: pair[1] - pair[0])]
        self._fixed = [(slice(stretch[0], stretch[-1] + 1),
                        template.content[stretch[0]:stretch[-1] + 1]) for stretch in stretches]

    def fits(self, data):
        """Tell whether a message is as long as this, and alike but for its numbers."""
        return len(data) >= self._size and all(
            data[place] == content for place, content in self._fixed)
