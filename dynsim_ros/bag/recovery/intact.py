# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Whether a record of an MCAP file is whole, checked as strictly as its kind allows."""

from __future__ import annotations

from io import BytesIO
import struct
from typing import Any, BinaryIO, NamedTuple

from mcap import records
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
import numpy as np

from ..checksum import crc32
from ..chunk_content import ChunkHead, DamagedChunk, LARGEST_CHUNK, open_chunk, read_head
from ..chunk_records import ChunkRecords, records_of
from ..records import HEAD, MESSAGE, Record
from ..summary import as_bytes, AttachmentHead, ENTRY_SIZE, INDEX_HEAD

# A chunk's head takes no more than this [bytes].
CHUNK_HEAD = 64

_PLAIN = {
    Opcode.HEADER: records.Header, Opcode.FOOTER: records.Footer, Opcode.SCHEMA: records.Schema,
    Opcode.CHANNEL: records.Channel, Opcode.METADATA: records.Metadata,
    Opcode.CHUNK_INDEX: records.ChunkIndex, Opcode.STATISTICS: records.Statistics,
    Opcode.ATTACHMENT_INDEX: records.AttachmentIndex,
    Opcode.METADATA_INDEX: records.MetadataIndex, Opcode.SUMMARY_OFFSET: records.SummaryOffset,
    Opcode.DATA_END: records.DataEnd}
# Schemas in these encodings are texts: readers fail where they are none.
_TEXTS = ('ros1msg', 'ros2msg', 'ros2idl', 'omgidl', 'jsonschema')
# From here on opcodes are for private use: such records are kept as they are.
PRIVATE = 0x80
_PORTION = 1024 * 1024


class NotIntact(ValueError):
    """A record that is not whole; cost: bytes that were looked at to find that out."""

    def __init__(self, reason: str, cost: int = 0):
        """Keep both."""
        super().__init__(reason)
        self.cost = cost


class OpenChunk(NamedTuple):
    """A chunk that is whole: its head, its content and the records in that."""

    head: ChunkHead
    data: bytes
    records: ChunkRecords


def parsed(record: Record, stream: BinaryIO) -> Any:
    """
    Return what a record says; raises NotIntact.

    An OpenChunk, an AttachmentHead, (channel, entries) of a message index, None for a message or
    what is for private use, else a record of the MCAP library.
    """
    length = record.end - record.start - HEAD.size
    if record.opcode == Opcode.CHUNK:
        return _chunk(record, stream)
    if record.opcode == Opcode.ATTACHMENT:
        return _attachment(record, stream)
    if record.opcode == Opcode.MESSAGE or record.opcode >= PRIVATE:
        if record.opcode == Opcode.MESSAGE and length < MESSAGE.size:
            raise NotIntact('it is too short for a message')
        return None
    if length > LARGEST_CHUNK:
        raise NotIntact(f'it says that it has {length} bytes')
    if record.opcode == Opcode.MESSAGE_INDEX:
        return _message_index(record.read(stream))
    if record.opcode not in _PLAIN:
        raise NotIntact('there is no such kind of record')
    return _plain(record.opcode, record.read(stream))


def chunk_head(record: Record, stream: BinaryIO) -> ChunkHead:
    """Return the head of a chunk that fits the record, which may be cut off; raises NotIntact."""
    stream.seek(record.start + HEAD.size)
    try:
        head = read_head(stream.read(min(CHUNK_HEAD, record.end - record.start - HEAD.size)))
    except DamagedChunk as error:
        raise NotIntact(str(error), CHUNK_HEAD) from None
    if head.start + head.length != record.end - record.start - HEAD.size or (
            head.compression not in ('', 'lz4', 'zstd')):
        raise NotIntact('its head does not fit', CHUNK_HEAD)
    return head


def _chunk(record, stream):
    head = chunk_head(record, stream)
    cost = head.length + min(head.size, LARGEST_CHUNK)
    if head.length > LARGEST_CHUNK:
        raise NotIntact(f'it says that it has {head.length} bytes')
    try:
        data = open_chunk(record.read(stream))
    except DamagedChunk as error:
        raise NotIntact(str(error), cost) from None
    found = records_of(data)
    if found.end != len(data):
        raise NotIntact('the records in it do not fit', cost)
    return OpenChunk(head, data, found)


def _message_index(content):
    size = INDEX_HEAD.size - HEAD.size
    if len(content) < size:
        raise NotIntact('it is too short for an index')
    channel, length = struct.unpack_from('<HI', content)
    if length != len(content) - size or length % ENTRY_SIZE:
        raise NotIntact('its length does not fit', len(content))
    return channel, np.frombuffer(content, '<u8', offset=size).reshape(-1, 2)


def _plain(opcode, content):
    kind = _PLAIN[opcode]
    try:
        found = kind.read(ReadDataStream(BytesIO(content)))
        if opcode == Opcode.SCHEMA and found.encoding in _TEXTS:
            found.data.decode()
        if opcode == Opcode.HEADER and not f'{found.profile}{found.library}'.isprintable():
            raise NotIntact('its texts are none', len(content))
    except (McapError, struct.error, UnicodeDecodeError, MemoryError, OverflowError) as error:
        raise NotIntact(f'it cannot be read: {error}', len(content)) from None
    # What is there, but for what later versions of the format may append, has to come out again.
    if not content.startswith(as_bytes(found)[HEAD.size:]):
        raise NotIntact('its lengths do not fit', len(content))
    return found


def _attachment(record, stream):
    stream.seek(record.start + HEAD.size)
    rest = record.end - record.start - HEAD.size
    begin = stream.read(min(rest, _PORTION))
    try:
        times = struct.unpack_from('<QQ', begin)
        name, at = _text(begin, 16)
        media_type, at = _text(begin, at)
        (size,) = struct.unpack_from('<Q', begin, at)
    except (struct.error, UnicodeDecodeError) as error:
        raise NotIntact(f'it cannot be read: {error}', len(begin)) from None
    if at + 8 + size + 4 != rest:
        raise NotIntact('its lengths do not fit', len(begin))
    stream.seek(record.start + HEAD.size)
    crc = 0
    for portion in portions(stream, record.start + HEAD.size, record.end - 4):
        crc = crc32(portion, crc)
    told = int.from_bytes(stream.read(4), 'little')
    if told and told != crc:
        raise NotIntact('its checksum is wrong', rest)
    return AttachmentHead(*times, name, media_type, size)


def _text(data, at):
    """Return a text and where it ends."""
    (length,) = struct.unpack_from('<I', data, at)
    if at + 4 + length > len(data):
        raise struct.error('a text is longer than the record')
    return data[at + 4:at + 4 + length].decode(), at + 4 + length


def portions(stream: BinaryIO, start: int, end: int):
    """Yield what lies between two positions of a file, portion by portion."""
    stream.seek(start)
    while start < end:
        portion = stream.read(min(end - start, _PORTION))
        if not portion:
            return
        start += len(portion)
        yield portion
