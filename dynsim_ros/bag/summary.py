# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The end of an MCAP file, which tells what lies where in it: noted while the file is written."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
import os
import struct
import tempfile
from typing import Any, NamedTuple

from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    AttachmentIndex,
    DataEnd,
    Footer,
    McapRecord,
    Metadata,
    MetadataIndex,
    Statistics,
    SummaryOffset,
)

from .checksum import crc32
from .output import Output
from .records import HEAD, MAGIC

# A message index up to its entries; each of these is log time and place in the chunk.
INDEX_HEAD = struct.Struct('<BQHI')
ENTRY_SIZE = 16
# As plain numbers and names: these are needed for every chunk of every channel.
_MESSAGE_INDEX, _CHUNK_OPCODE = int(Opcode.MESSAGE_INDEX), int(Opcode.CHUNK)
_INDEX_START, _pack_index = INDEX_HEAD.size - HEAD.size, INDEX_HEAD.pack

_CHUNK = struct.Struct('<QQQI')
_CHUNK_INDEX = struct.Struct('<QQQQI')
_OFFSET = struct.Struct('<HQ')
_TWO = struct.Struct('<QQ')
_PORTION = 64 * 1024
_DECLARED = (Opcode.SCHEMA, Opcode.CHANNEL)
_INDEXES = (Opcode.ATTACHMENT_INDEX, Opcode.METADATA_INDEX)


class ChunkPlace(NamedTuple):
    """
    What a chunk and its index tell of it: first byte of its record, first and last log time.

    compression: as MCAP names it; compressed, size: bytes of what it holds, as it is and after
    decompression; crc: of the latter.
    """

    at: int
    start_ns: int
    end_ns: int
    compression: str
    compressed: int
    size: int
    crc: int

    @property
    def length(self) -> int:
        """Return how many bytes the record is."""
        return (HEAD.size + _CHUNK.size + len(text_bytes(self.compression)) + 8
                + self.compressed)

    def head(self) -> bytes:
        """Return the record up to what it holds."""
        return b''.join((
            HEAD.pack(_CHUNK_OPCODE, self.length - HEAD.size),
            _CHUNK.pack(self.start_ns, self.end_ns, self.size, self.crc),
            text_bytes(self.compression), struct.pack('<Q', self.compressed)))


class Summary:
    """
    Notes what is in a file, and writes it behind that.

    size: bytes that all of it takes, about.
    """

    def __init__(self, folder: str | os.PathLike):
        """Begin with nothing; folder: where there is room for as much as the file will hold."""
        self._chunk_indexes = _Spool(folder)
        self._groups: dict[Opcode, list[bytes]] = {
            opcode: [] for opcode in (*_DECLARED, *_INDEXES)}
        self._counts: dict[int, int] = {}
        self._chunks = 0
        self._times: tuple[int, int] | None = None
        self.size = 0

    @property
    def messages(self) -> int:
        """Return the number of messages in all chunks."""
        return sum(self._counts.values())

    def count_of(self, opcode: Opcode) -> int:
        """Return how many records of a kind were noted."""
        return len(self._groups[opcode])

    def note_declared(self, opcode: Opcode, record: bytes):
        """Note a schema or a channel, a whole record."""
        self._add(opcode, record)

    def note_record(self, opcode: Opcode, start: int, end: int, said: Any):
        """
        Note a metadata record or an attachment that lies between two positions.

        said: has what it says as attributes, named as in the MCAP library.
        """
        if opcode == Opcode.METADATA:
            index = MetadataIndex(offset=start, length=end - start, name=said.name)
            self._add(Opcode.METADATA_INDEX, as_bytes(index))
            return
        self._add(Opcode.ATTACHMENT_INDEX, as_bytes(AttachmentIndex(
            offset=start, length=end - start, log_time=said.log_time,
            create_time=said.create_time, data_size=said.data_size, name=said.name,
            media_type=said.media_type)))

    def note_chunk(self, place: ChunkPlace, indexes: Mapping[int, int]):
        """Note a chunk, and the indexes that follow it: {channel: bytes of the record}."""
        start = end = place.at + place.length
        offsets, counts = [], self._counts
        for channel, length in indexes.items():
            offsets.append(_OFFSET.pack(channel, end))
            end += length
            counts[channel] = counts.get(channel, 0) + (length - INDEX_HEAD.size) // ENTRY_SIZE
        body = b''.join((
            _CHUNK_INDEX.pack(place.start_ns, place.end_ns, place.at, start - place.at,
                              len(offsets) * _OFFSET.size),
            *offsets, struct.pack('<Q', end - start), text_bytes(place.compression),
            _TWO.pack(place.compressed, place.size)))
        self._chunk_indexes.add(HEAD.pack(Opcode.CHUNK_INDEX, len(body)) + body)
        self.size += HEAD.size + len(body)
        if indexes:
            start_ns, end_ns = self._times or (place.start_ns, place.end_ns)
            self._times = min(start_ns, place.start_ns), max(end_ns, place.end_ns)
        self._chunks += 1

    def write(self, output: Output):
        """Append it to the file; if that fails, nothing is left of it."""
        end_of_data = output.tell()
        try:
            output.write(as_bytes(DataEnd(0)))
            summary = _Writing(output)
            for opcode in _DECLARED:
                summary.add(opcode, self._groups[opcode])
            summary.add(Opcode.STATISTICS, [as_bytes(self._statistics())])
            summary.add(Opcode.CHUNK_INDEX, self._chunk_indexes.parts())
            for opcode in _INDEXES:
                summary.add(opcode, self._groups[opcode])
            summary.finish()
        except OSError:
            output.cut(end_of_data)
            raise

    def close(self):
        """Forget all of it."""
        self._chunk_indexes.close()

    def __enter__(self) -> Summary:
        """Return it."""
        return self

    def __exit__(self, *_):
        """Forget all of it."""
        self.close()

    def _add(self, opcode, record):
        self._groups[opcode].append(record)
        self.size += len(record)

    def _statistics(self):
        groups, (start_ns, end_ns) = self._groups, self._times or (0, 0)
        return Statistics(
            message_count=self.messages, schema_count=len(groups[Opcode.SCHEMA]),
            channel_count=len(groups[Opcode.CHANNEL]),
            attachment_count=len(groups[Opcode.ATTACHMENT_INDEX]),
            metadata_count=len(groups[Opcode.METADATA_INDEX]), chunk_count=self._chunks,
            message_start_time=start_ns, message_end_time=end_ns,
            channel_message_counts=self._counts)


class _Spool:
    """
    Bytes that grow with the run: they wait in a nameless file, so that memory stays the same.

    Where the disk has no room for them they wait in memory: noting what was written never fails.
    """

    def __init__(self, folder):
        self._file = tempfile.TemporaryFile(dir=folder, buffering=0)
        self._size = 0
        self._rest = bytearray()

    def add(self, data):
        """Append bytes."""
        self._rest += data
        if len(self._rest) < _PORTION:
            return
        with suppress(OSError):
            while self._rest:
                count = os.pwrite(self._file.fileno(), self._rest, self._size)
                self._size += count
                del self._rest[:count]

    def parts(self):
        """Yield all of them, portion by portion."""
        for at in range(0, self._size, _PORTION):
            yield os.pread(self._file.fileno(), min(_PORTION, self._size - at), at)
        yield bytes(self._rest)

    def close(self):
        """Forget them."""
        self._file.close()


class _Writing:
    """The summary, written group by group; its checksum is kept along."""

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
            self._offsets.append(as_bytes(SummaryOffset(opcode, start, length)))

    def finish(self):
        """Append where each kind is, and the footer."""
        offsets = self._output.tell()
        self._write(b''.join(self._offsets))
        self._write_crc(HEAD.pack(Opcode.FOOTER, 20) + _TWO.pack(self._start, offsets))
        self._output.write(as_bytes(Footer(self._start, offsets, self._crc)) + MAGIC)

    def _write(self, data):
        self._output.write(data)
        self._write_crc(data)

    def _write_crc(self, data):
        self._crc = crc32(data, self._crc)


def as_bytes(record: McapRecord) -> bytes:
    """Return a record as it stands in a file."""
    builder = RecordBuilder()
    record.write(builder)
    return builder.end()


class AttachmentHead(NamedTuple):
    """What an attachment says of itself."""

    log_time: int
    create_time: int
    name: str
    media_type: str
    data_size: int


def write_record(output: Output, summary: Summary, record: Metadata | Attachment):
    """Append a metadata record or an attachment to a file, and note it."""
    start, data = output.tell(), as_bytes(record)
    output.write(data)
    if isinstance(record, Metadata):
        summary.note_record(Opcode.METADATA, start, output.tell(), record)
        return
    summary.note_record(Opcode.ATTACHMENT, start, output.tell(), AttachmentHead(
        record.log_time, record.create_time, record.name, record.media_type, len(record.data)))


def message_index(channel: int, entries: bytes) -> bytes:
    """Return the index of a channel's messages in a chunk, a whole record; see ENTRY_SIZE."""
    size = len(entries)
    return _pack_index(_MESSAGE_INDEX, _INDEX_START + size, channel, size) + entries


def text_bytes(text: str) -> bytes:
    """Return a text as it stands in a record."""
    data = text.encode()
    return struct.pack('<I', len(data)) + data
