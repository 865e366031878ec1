# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Records of an MCAP file, walked one by one; chunks are opened on the way."""

from __future__ import annotations

from collections.abc import Iterator
import struct
from typing import BinaryIO, NamedTuple

from mcap.opcode import Opcode

from .chunk_content import DamagedChunk, open_chunk

MAGIC = b'\x89MCAP0\r\n'

# Opcode and length of the content, before every record.
HEAD = struct.Struct('<BQ')

# Channel, sequence number, log time and publish time, before a message's data.
MESSAGE = struct.Struct('<HIQQ')


class Record(NamedTuple):
    """Where a record lies in a file: its opcode, first byte, and the byte behind it."""

    opcode: int
    start: int
    end: int

    def read(self, stream: BinaryIO) -> bytes:
        """Return the record's content."""
        stream.seek(self.start + HEAD.size)
        return stream.read(self.end - self.start - HEAD.size)


class Message(NamedTuple):
    """A message of a channel with its log time in ns."""

    log_ns: int
    channel_id: int
    data: bytes


def walk(stream: BinaryIO, start: int, end: int) -> Iterator[Record]:
    """Yield the records that lie whole between two positions; stops at what is no record."""
    while start + HEAD.size <= end:
        stream.seek(start)
        opcode, length = HEAD.unpack(stream.read(HEAD.size))
        record = Record(opcode, start, start + HEAD.size + length)
        if opcode == 0 or record.end > end:
            return
        yield record
        start = record.end


def parts(data: bytes) -> Iterator[tuple[int, int, int]]:
    """Yield (opcode, start and end of the content) of the records that `data` consists of."""
    at, end = 0, len(data)
    while at < end:
        if at + HEAD.size > end:
            raise DamagedChunk('it ends within a record')
        opcode, length = HEAD.unpack_from(data, at)
        start = at + HEAD.size
        at = start + length
        if at > end:
            raise DamagedChunk('it ends within a record')
        yield opcode, start, at


def messages_in(data: bytes, *, in_chunk: bool = False) -> Iterator[Message]:
    """Yield the messages among records, those within chunks too, in the order they lie there."""
    for opcode, start, end in parts(data):
        if opcode == Opcode.MESSAGE:
            if end - start < MESSAGE.size:
                raise DamagedChunk('it holds a message that is too short')
            channel_id, _, log_ns, _ = MESSAGE.unpack_from(data, start)
            yield Message(log_ns, channel_id, data[start + MESSAGE.size:end])
        elif opcode == Opcode.CHUNK and not in_chunk:
            yield from messages_in(open_chunk(data[start:end]), in_chunk=True)
