# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""An MCAP file written record by record; what its summary needs of the chunks is kept on disk."""

from __future__ import annotations

from collections import Counter
import os
from pathlib import Path
import struct
import tempfile
import zlib

import lz4.frame
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    AttachmentIndex,
    Channel,
    DataEnd,
    Footer,
    Header,
    McapRecord,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)
import zstandard

from .mcap_chunk import Chunk
from .output import Output
from .records import HEAD, MAGIC

_CHUNK = struct.Struct('<QQQI')
_CHUNK_INDEX = struct.Struct('<QQQQI')
_OFFSET = struct.Struct('<HQ')
_TWO = struct.Struct('<QQ')


def _compressor(compression):
    """Return what compresses bytes; compression: as MCAP names it."""
    if compression == 'zstd':
        # Twice as fast as the usual level 3, for 5 % more bytes.
        return zstandard.ZstdCompressor(level=-1).compress
    return lz4.frame.compress if compression == 'lz4' else bytes


class McapFile:
    """
    A new MCAP file.

    compression: 'zstd', 'lz4' or '' for none. Schemas and channels are written before the chunk
    in which they are used first. An index of the chunks grows with the run: until the end it lies
    in a nameless file, so that the memory that is needed stays the same.
    """

    def __init__(self, path: str | os.PathLike, compression: str, library: str):
        """Create the file; raises FileExistsError if it exists."""
        self._compression = _string(compression)
        self._compress = _compressor(compression)
        self._output = Output(path)
        self._chunk_indexes = None
        self._groups: dict[Opcode, list[bytes]] = {opcode: [] for opcode in (
            Opcode.SCHEMA, Opcode.CHANNEL, Opcode.ATTACHMENT_INDEX, Opcode.METADATA_INDEX)}
        self._counts: Counter = Counter()
        self._chunks = self._start_ns = self._end_ns = 0
        try:
            self._chunk_indexes = tempfile.TemporaryFile(dir=Path(path).parent)
            self._output.write(MAGIC + _bytes(Header('ros2', library)))
        except BaseException:
            self.close()
            raise

    def add_schema(self, name: str, encoding: str, data: bytes) -> int:
        """Declare a message type; return its id."""
        number = len(self._groups[Opcode.SCHEMA]) + 1
        return self._declare(Opcode.SCHEMA, number, Schema(number, data, encoding, name))

    def add_channel(self, topic: str, schema_id: int, metadata: dict[str, str]) -> int:
        """Declare a topic of CDR messages; return its id."""
        number = len(self._groups[Opcode.CHANNEL]) + 1
        return self._declare(Opcode.CHANNEL, number,
                             Channel(number, topic, 'cdr', metadata, schema_id))

    def add_metadata(self, name: str, values: dict[str, str]):
        """Append a record of names and texts."""
        at, record = self._output.tell(), _bytes(Metadata(name, values))
        self._output.write(record)
        self._groups[Opcode.METADATA_INDEX].append(
            _bytes(MetadataIndex(offset=at, length=len(record), name=name)))

    def add_attachment(self, name: str, data: bytes, media_type: str, stamp_ns: int):
        """Append a whole file under a name."""
        at = self._output.tell()
        record = _bytes(Attachment(create_time=0, log_time=stamp_ns, name=name,
                                   media_type=media_type, data=data))
        self._output.write(record)
        self._groups[Opcode.ATTACHMENT_INDEX].append(_bytes(AttachmentIndex(
            offset=at, length=len(record), log_time=stamp_ns, create_time=0,
            data_size=len(data), name=name, media_type=media_type)))

    def add_chunk(self, chunk: Chunk):
        """Append the messages of a chunk with their indexes, in one write."""
        content, indexes = chunk.content(), chunk.indexes()
        data = self._compress(content)
        body = (_CHUNK.pack(chunk.start_ns, chunk.end_ns, len(content), zlib.crc32(content))
                + self._compression + struct.pack('<Q', len(data)))
        record = HEAD.pack(Opcode.CHUNK, len(body) + len(data)) + body + data
        at = self._output.tell()
        self._output.write(b''.join([record, *indexes.values()]))
        self._note_chunk(chunk, at, len(record), indexes, len(data))

    def _note_chunk(self, chunk, at, length, indexes, compressed):
        """Keep what the summary is to tell of a chunk."""
        offsets, end = [], at + length
        for channel, index in indexes.items():
            offsets.append(_OFFSET.pack(channel, end))
            end += len(index)
            # A head of 15 bytes, then 16 for each message.
            self._counts[channel] += len(index) // 16
        body = (_CHUNK_INDEX.pack(chunk.start_ns, chunk.end_ns, at, length,
                                  len(offsets) * _OFFSET.size) + b''.join(offsets)
                + struct.pack('<Q', end - at - length) + self._compression
                + _TWO.pack(compressed, chunk.size))
        self._chunk_indexes.write(HEAD.pack(Opcode.CHUNK_INDEX, len(body)) + body)
        self._start_ns = self._start_ns if self._chunks else chunk.start_ns
        self._end_ns = chunk.end_ns
        self._chunks += 1

    def finish(self):
        """Append the summary."""
        self._output.write(_bytes(DataEnd(0)))
        summary = _Summary(self._output)
        for opcode in (Opcode.SCHEMA, Opcode.CHANNEL):
            summary.add(opcode, self._groups[opcode])
        summary.add(Opcode.STATISTICS, [_bytes(self._statistics())])
        self._chunk_indexes.seek(0)
        summary.add(Opcode.CHUNK_INDEX, iter(lambda: self._chunk_indexes.read(2 ** 16), b''))
        for opcode in (Opcode.ATTACHMENT_INDEX, Opcode.METADATA_INDEX):
            summary.add(opcode, self._groups[opcode])
        summary.finish()

    def close(self):
        """Close the file."""
        self._output.close()
        if self._chunk_indexes is not None:
            self._chunk_indexes.close()

    def _declare(self, opcode, number, record):
        data = _bytes(record)
        self._output.write(data)
        self._groups[opcode].append(data)
        return number

    def _statistics(self):
        groups = self._groups
        return Statistics(
            message_count=self._counts.total(), schema_count=len(groups[Opcode.SCHEMA]),
            channel_count=len(groups[Opcode.CHANNEL]),
            attachment_count=len(groups[Opcode.ATTACHMENT_INDEX]),
            metadata_count=len(groups[Opcode.METADATA_INDEX]), chunk_count=self._chunks,
            message_start_time=self._start_ns, message_end_time=self._end_ns,
            channel_message_counts=dict(self._counts))


class _Summary:
    """The end of a file, written group by group; its checksum is kept along."""

    def __init__(self, output):
        self._output = output
        self._start = output.tell()
        self._crc = 0
        self._offsets = []

    def add(self, opcode, parts):
        """Append the records of one kind."""
        start = self._output.tell()
        for part in parts:
            self._write(part)
        length = self._output.tell() - start
        if length:
            self._offsets.append(_bytes(SummaryOffset(opcode, start, length)))

    def finish(self):
        """Append where each kind is, and the footer."""
        offsets = self._output.tell()
        self._write(b''.join(self._offsets))
        self._write_crc(HEAD.pack(Opcode.FOOTER, 20) + _TWO.pack(self._start, offsets))
        self._output.write(_bytes(Footer(self._start, offsets, self._crc)) + MAGIC)

    def _write(self, data):
        self._output.write(data)
        self._write_crc(data)

    def _write_crc(self, data):
        self._crc = zlib.crc32(data, self._crc)


def _string(text):
    data = text.encode()
    return struct.pack('<I', len(data)) + data


def _bytes(record: McapRecord) -> bytes:
    """Return a record as it stands in a file."""
    builder = RecordBuilder()
    record.write(builder)
    return builder.end()
