# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A new file of all that is intact in another one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import BinaryIO

from mcap import records
from mcap.opcode import Opcode

from .intact import portions, PRIVATE
from .search import Piece
from .stretches import Hole, stretches, WholeChunk
from .survey import Survey, whole
from ..checksum import crc32
from ..chunk_records import ChunkRecords, records_of
from ..mcap_file import compressor
from ..output import Output
from ..records import HEAD, MAGIC, Record
from ..summary import as_bytes, ChunkPlace, Summary

# Messages that lie in no chunk, or in none that is whole, go to new ones of about this size.
_CHUNK_SIZE = 256 * 1024
_COMPRESSION = 'zstd'
_COPIED = (Opcode.METADATA, Opcode.ATTACHMENT)


class Rebuild:
    """
    Copies what a Survey found intact to another file, in its order; chunks as they are.

    What is written can be finished by its summary.
    """

    def __init__(self, stream: BinaryIO, size: int, survey: Survey, output: Output,
                 summary: Summary):
        """Copy; raises OSError."""
        self._stream, self._survey = stream, survey
        self._output, self._summary = output, summary
        self._loose = bytearray()
        self._compress = compressor(_COMPRESSION)
        output.write(MAGIC + as_bytes(survey.header or records.Header(_profile(survey), '')))
        self._declare()
        for stretch in stretches(stream, size):
            if isinstance(stretch, Piece) and stretch.record.opcode == Opcode.DATA_END:
                break
            self._copy(stretch)
        self._end_chunk()

    def _declare(self):
        """Write all schemas and channels that messages can have."""
        survey = self._survey
        for kind in (Opcode.SCHEMA, Opcode.CHANNEL):
            for (opcode, key), record in survey.declared.items():
                if opcode == kind and (kind == Opcode.SCHEMA or key in survey.described):
                    self._output.write(record)
                    self._summary.note_declared(kind, record)

    def _copy(self, stretch):
        """Copy what comes next."""
        if isinstance(stretch, WholeChunk):
            self._copy_chunk(stretch)
        elif isinstance(stretch, Hole):
            remains = stretch.remains(self._stream)
            if remains is not None:
                self._take_messages(*remains)
        elif stretch.record.opcode == Opcode.MESSAGE:
            data = whole(self._stream, stretch.record)
            self._take_messages(data, records_of(data))
        elif stretch.record.opcode in _COPIED or stretch.record.opcode >= PRIVATE:
            self._copy_record(*stretch)

    def _copy_chunk(self, chunk):
        self._end_chunk()
        if not chunk.records.counts().keys() <= self._survey.described:
            self._take_messages(chunk.data, chunk.records)
            return
        place = chunk.place(self._output.tell())
        data = whole(self._stream, chunk.record)[-chunk.head.length:]
        self._write_chunk(place, data if chunk.head.length else b'', chunk.indexes)

    def _write_chunk(self, place: ChunkPlace, data: bytes, indexes: Mapping[int, bytes]):
        self._output.write(b''.join((place.head(), data, *indexes.values())))
        self._summary.note_chunk(
            place, {channel: len(index) for channel, index in indexes.items()})

    def _take_messages(self, data: bytes, found: ChunkRecords):
        """Take in the messages among some records, of channels that are described."""
        for start in found.of(self._survey.described).starts():
            _, length = HEAD.unpack_from(data, start)
            self._loose += data[start:start + HEAD.size + length]
            if len(self._loose) >= _CHUNK_SIZE:
                self._end_chunk()

    def _end_chunk(self):
        """Write the messages that were taken in, if there are any, as a chunk."""
        if not self._loose:
            return
        content = bytes(self._loose)
        self._loose.clear()
        found, data = records_of(content), self._compress(content)
        place = ChunkPlace(self._output.tell(), *found.times, _COMPRESSION, len(data),
                           len(content), crc32(content))
        self._write_chunk(place, data, found.indexes())

    def _copy_record(self, record: Record, value):
        """Copy a record as it is."""
        self._end_chunk()
        at = self._output.tell()
        for portion in portions(self._stream, record.start, record.end):
            self._output.write(portion)
        if record.opcode in _COPIED:
            self._summary.note_record(record.opcode, at, self._output.tell(), value)


def _profile(survey):
    """Return the profile of a file whose header is lost: of one with messages of ROS 2, that."""
    return 'ros2' if any(b'ros2msg' in record for record in survey.declared.values()) else ''
