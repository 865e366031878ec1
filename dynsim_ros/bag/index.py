# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What an MCAP file holds and where: from its summary, or by a scan where that is missing."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from io import BytesIO
import os
import struct
from typing import BinaryIO, NamedTuple

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Metadata, Schema, Statistics

from .checksum import crc32
from .chunk_content import DamagedChunk, open_chunk
from .records import HEAD, MAGIC, MESSAGE, Record, walk

# Messages outside chunks are read in portions of about this many bytes.
_PORTION = 256 * 1024

# A footer with what comes behind it: where summary and offsets begin, a checksum, the magic.
_END = struct.Struct('<BQQQI8s')
_FOOTER = 20
# What an index of a chunk begins with, up to the places of its message indexes; what an index of
# an attachment or metadata begins with.
_CHUNK_INDEX = struct.Struct('<QQQQI')
_OFFSET = _LENGTH = struct.Struct('<Q')


class Block(NamedTuple):
    """
    A stretch of a file that is read at once: first and last log time, first byte, end.

    index_size: how many bytes of message indexes follow it, as far as known.
    """

    start_ns: int
    end_ns: int
    start: int
    end: int
    index_size: int = 0


@dataclass
class Index:
    """
    The content of a file, without the messages themselves.

    counts: messages by channel id. problem: one line where the file is not whole, else None.
    """

    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    counts: Counter = field(default_factory=Counter)
    blocks: list[Block] = field(default_factory=list)
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)
    attachments: list[Record] = field(default_factory=list)
    problem: str | None = None


def read_index(stream: BinaryIO) -> Index:
    """Return the index of a file that begins with MCAP's magic bytes."""
    size = stream.seek(0, os.SEEK_END)
    stream.seek(0)
    try:
        index = _from_summary(stream, size)
    except (McapError, ValueError, struct.error, OSError):
        index = None
    return index or _Scan(stream, size).index


def _from_summary(stream: BinaryIO, size: int) -> Index | None:
    """Return the index that the summary gives, None where it lacks something."""
    start = _summary_start(stream, size)
    index, found, told = Index(), Counter(), None
    for record in walk(stream, start, size - _END.size):
        content = record.read(stream)
        found[record.opcode] += 1
        if record.opcode in (Opcode.SCHEMA, Opcode.CHANNEL):
            _declare(index, record.opcode, content)
        elif record.opcode == Opcode.CHUNK_INDEX:
            start_ns, end_ns, at, length, places = _CHUNK_INDEX.unpack_from(content)
            index_size, = _LENGTH.unpack_from(content, _CHUNK_INDEX.size + places)
            index.blocks.append(Block(start_ns, end_ns, at, at + length,
                                      min(index_size, max(size - at - length, 0))))
        elif record.opcode == Opcode.ATTACHMENT_INDEX:
            at, = _OFFSET.unpack_from(content)
            index.attachments.append(_record_at(stream, at, size, Opcode.ATTACHMENT))
        elif record.opcode == Opcode.METADATA_INDEX:
            at, = _OFFSET.unpack_from(content)
            _add_metadata(index, _record_at(stream, at, size, Opcode.METADATA).read(stream))
        elif record.opcode == Opcode.STATISTICS:
            told = Statistics.read(_stream(content))
    if told is None or (told.message_count and not index.blocks) or (
            len(index.channels), len(index.schemas), len(index.blocks), len(index.attachments),
            found[Opcode.METADATA_INDEX]) != (
                told.channel_count, told.schema_count, told.chunk_count, told.attachment_count,
                told.metadata_count):
        return None
    index.counts = Counter(told.channel_message_counts)
    return index


def _summary_start(stream, size):
    """Return where the summary begins; raise ValueError where there is none, or it is damaged."""
    stream.seek(max(size - _END.size, 0))
    opcode, length, start, _, told, magic = _END.unpack(stream.read(_END.size))
    if (opcode, length, magic) != (Opcode.FOOTER, _FOOTER, MAGIC) or not (
            0 < start <= size - _END.size):
        raise ValueError('there is no summary')
    if told:
        stream.seek(start)
        # Its checksum covers the footer, too, up to the checksum itself.
        rest, crc = size - len(MAGIC) - 4 - start, 0
        while rest:
            portion = stream.read(min(rest, _PORTION))
            rest, crc = rest - len(portion), crc32(portion, crc)
        if crc != told:
            raise ValueError('the summary is damaged')
    return start


def _record_at(stream, at, size, opcode):
    """Return the record of a kind that begins somewhere; raise ValueError where none does."""
    record = next(walk(stream, at, size), None)
    if record is None or record.opcode != opcode:
        raise ValueError('the summary is wrong')
    return record


def _declare(index: Index, opcode: int, content: bytes):
    """Take in a schema or a channel."""
    if opcode == Opcode.SCHEMA:
        schema = Schema.read(_stream(content))
        index.schemas[schema.id] = schema
    else:
        channel = Channel.read(_stream(content))
        index.channels[channel.id] = channel


def _add_metadata(index: Index, content: bytes):
    """Add a metadata record; of two with one name, what the later one says counts."""
    record = Metadata.read(_stream(content))
    index.metadata.setdefault(record.name, {}).update(record.metadata)


def _stream(content: bytes) -> ReadDataStream:
    """Return bytes as the MCAP library reads them."""
    return ReadDataStream(BytesIO(content))


class _Scan:
    """Reads a file from its beginning to where it ends, or breaks off."""

    def __init__(self, stream: BinaryIO, size: int):
        """Read the file."""
        self.index = Index()
        self._stream = stream
        self._finished = False
        self._damaged = 0
        self._portion: Block | None = None
        end = len(MAGIC)
        for record in walk(stream, end, size):
            try:
                self._add(record)
            except (DamagedChunk, McapError, struct.error, UnicodeDecodeError):
                self._damaged += 1
            end = record.end
            if self._finished:
                break
        self._end_portion()
        self.index.problem = self._problem(end, size)

    def _add(self, record: Record):
        """Take in one record."""
        if record.opcode == Opcode.MESSAGE:
            self._stream.seek(record.start + HEAD.size)
            channel_id, _, log_ns, _ = MESSAGE.unpack(self._stream.read(MESSAGE.size))
            self._add_message(record, channel_id, log_ns)
        elif record.opcode == Opcode.CHUNK:
            self._add_chunk(record)
        elif record.opcode in (Opcode.SCHEMA, Opcode.CHANNEL):
            _declare(self.index, record.opcode, record.read(self._stream))
        elif record.opcode == Opcode.METADATA:
            _add_metadata(self.index, record.read(self._stream))
        elif record.opcode == Opcode.ATTACHMENT:
            self.index.attachments.append(record)
        elif record.opcode == Opcode.FOOTER:
            self._finished = True

    def _add_chunk(self, record: Record):
        """Take in what a chunk declares and the times of its messages."""
        data = open_chunk(record.read(self._stream))
        # Imported here: most files have a summary, and need no compiled code to be read.
        from .chunk_records import records_of

        found = records_of(data)
        if found.end != len(data):
            raise DamagedChunk('its records do not fit')
        for at in found.others:
            opcode, length = HEAD.unpack_from(data, at)
            if opcode in (Opcode.SCHEMA, Opcode.CHANNEL):
                _declare(self.index, opcode, data[at + HEAD.size:at + HEAD.size + length])
        if len(found.messages):
            self._end_portion()
            self.index.counts.update(found.counts())
            self.index.blocks.append(Block(*found.times, record.start, record.end))

    def _add_message(self, record: Record, channel_id: int, log_ns: int):
        """Take in a message outside any chunk."""
        self.index.counts[channel_id] += 1
        block = self._portion or Block(log_ns, log_ns, record.start, record.end)
        self._portion = Block(min(block.start_ns, log_ns), max(block.end_ns, log_ns),
                              block.start, record.end)
        if record.end - block.start > _PORTION:
            self._end_portion()

    def _end_portion(self):
        """Close the run of messages outside chunks."""
        if self._portion:
            self.index.blocks.append(self._portion)
            self._portion = None

    def _problem(self, end: int, size: int) -> str | None:
        """Return one line that says what is wrong with the file, None where nothing is."""
        faults = []
        if not self._finished:
            faults.append(self._how_it_ends(end, size))
        if self._damaged:
            faults.append(f'{self._damaged} damaged record(s) left out')
        if not faults:
            return None
        blocks = self.index.blocks
        count = self.index.counts.total()
        if not count:
            return f"{' and '.join(faults)}: no message could be read"
        seconds = (max(block.end_ns for block in blocks)
                   - min(block.start_ns for block in blocks)) * 1e-9
        return f"{' and '.join(faults)}: {count} messages up to {seconds:.2f} s could be read"

    def _how_it_ends(self, end: int, size: int) -> str:
        """Return what is at the place where the scan stopped."""
        if end == size:
            return 'the file was not finished'
        self._stream.seek(end)
        opcode = self._stream.read(1)[0]
        if opcode == 0:
            return f'the file is damaged from byte {end} on'
        what = 'chunk' if opcode == Opcode.CHUNK else 'record'
        return f'the file ends in the middle of a {what}'
