# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What of an MCAP file is intact, and what it lacks: the look that comes before recovery."""

from __future__ import annotations

from bisect import bisect_right
from collections import Counter
from collections.abc import Iterator
from io import BytesIO
import struct
from typing import BinaryIO

from mcap import records
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode

from .intact import portions
from .search import Damage, Piece
from .stretches import Hole, stretches, WholeChunk
from ..checksum import crc32
from ..gap import MISSING
from ..records import HEAD, MAGIC, MESSAGE, Record
from ..summary import ENTRY_SIZE, INDEX_HEAD, Summary
from ...messages.qos import offered

# How much of the footer's content its checksum covers [bytes].
_COVERED = 16
_SUMMARY = (Opcode.DATA_END, Opcode.STATISTICS, Opcode.CHUNK_INDEX, Opcode.ATTACHMENT_INDEX,
            Opcode.METADATA_INDEX, Opcode.SUMMARY_OFFSET, Opcode.FOOTER)


class Survey:
    """
    Goes through a file and notes what is in it; nothing is changed.

    header: or None. declared: {(opcode, id): schema or channel, a whole record}; described:
    channels of which all is known; counts: messages by channel; first_ns, last_ns: their log
    times, None where there is no message; holes: what is missing; gaps: how
    many metadata records tell of what was missing before. is_whole: whether there is
    nothing to recover. is_cut: whether all of use lies before `end`, and is as it has to be: the
    file has only to be finished there; torn: a chunk that ends there and has no indexes yet, or
    None; summary: told of all before `end` but that chunk and what is declared.
    """

    def __init__(self, stream: BinaryIO, size: int, summary: Summary):
        """Go through a file of so many bytes; summary: one that was told of nothing yet."""
        self._stream, self.summary = stream, summary
        self.header: records.Header | None = None
        self.declared: dict[tuple[int, int], bytes] = {}
        self._declared_again: dict[tuple[int, int], bytes] = {}
        self.counts: Counter = Counter()
        self.first_ns: int | None = None
        self.last_ns: int | None = None
        self.holes: list[Hole] = []
        self.gaps = 0
        self.end = 0
        self.torn: WholeChunk | None = None
        self.is_cut = True
        self._schema_of: dict[int, int] = {}
        # Whether something was met behind which nothing may come, if the file is but cut off.
        self._is_broken = False
        self._has_wrong_index = self._is_misdeclared = False
        self._is_summary = self._is_summary_damaged = False
        self._has_good_end = self._is_summary_sound = False
        self._end_of_data = 0
        self._told: records.Statistics | None = None
        self._told_of_holes: list[tuple[Hole, records.ChunkIndex]] = []
        self._footer: Piece | None = None
        for stretch in stretches(stream, size):
            self._take(stretch)
        self._look_at_end()
        if self._has_good_end:
            self._look_up()
        if self._is_summary_sound:
            self._correct_declared()
        self._look_for_more()
        self.is_whole = self.header is not None and self._has_good_end and not (
            self.holes or self._has_wrong_index or self._is_misdeclared)

    @property
    def described(self) -> set[int]:
        """Return the channels of which all is known."""
        return {channel for channel, schema in self._schema_of.items()
                if schema == 0 or (Opcode.SCHEMA, schema) in self.declared}

    @property
    def messages(self) -> int:
        """Return the number of messages that are intact."""
        return sum(self.counts[channel] for channel in self.described)

    def _take(self, stretch):
        """Take in what comes next."""
        record = stretch.record if isinstance(stretch, Piece) else None
        self._is_summary = self._is_summary or (record is not None and record.opcode in _SUMMARY)
        if self._is_summary:
            self._take_summary(stretch)
        elif isinstance(stretch, Hole):
            self._take_hole(stretch)
        elif isinstance(stretch, WholeChunk):
            self._take_chunk(stretch)
        else:
            self._take_piece(*stretch)

    def _take_hole(self, hole):
        if hole.first_ns is None:
            hole.first_ns = self.last_ns
        self.holes.append(hole)
        self.is_cut = self.is_cut and hole.remains(self._stream) is None
        self._is_broken = True

    def _take_chunk(self, chunk):
        for opcode, record in declared_in(chunk):
            self._declare(opcode, record)
        self._count(chunk.records.counts(), *chunk.records.times)
        self._goes_on(chunk.end)
        self._has_wrong_index = self._has_wrong_index or not chunk.is_right
        if self._is_broken:
            return
        if not chunk.has_right_times:
            self.is_cut = False
        elif chunk.has_all_indexes:
            self.summary.note_chunk(chunk.place(chunk.record.start), chunk.lengths)
        else:
            self.torn, self.end, self._is_broken = chunk, chunk.record.end, True

    def _take_piece(self, record, value):
        if record.opcode == Opcode.HEADER:
            self.header = self.header or value
        elif record.opcode in (Opcode.SCHEMA, Opcode.CHANNEL):
            self._declare(record.opcode, whole(self._stream, record))
        elif record.opcode == Opcode.MESSAGE:
            channel, log_ns = message_head(self._stream, record)
            self._count({channel: 1}, log_ns, log_ns)
            # Without a chunk around it, it can stand in no index.
            self.is_cut = False
        elif record.opcode in (Opcode.METADATA, Opcode.ATTACHMENT):
            self.gaps += record.opcode == Opcode.METADATA and value.name.startswith(MISSING)
            if not self._is_broken:
                self.summary.note_record(record.opcode, record.start, record.end, value)
        self._goes_on(record.end)

    def _goes_on(self, end):
        """Note that what ends here is of use."""
        if self._is_broken:
            self.is_cut = False
        else:
            self.end = end

    def _take_summary(self, stretch):
        if not isinstance(stretch, Piece):
            self._is_summary_damaged = True
            return
        record, value = stretch
        if record.opcode == Opcode.DATA_END:
            self._end_of_data = record.end
        elif record.opcode in (Opcode.SCHEMA, Opcode.CHANNEL):
            data = whole(self._stream, record)
            self._declare(record.opcode, data)
            self._declared_again[record.opcode, _id_of(data)] = data
        elif record.opcode == Opcode.STATISTICS:
            self._told = value
        elif record.opcode == Opcode.CHUNK_INDEX:
            number = bisect_right(self.holes, value.chunk_start_offset,
                                  key=lambda hole: hole.start)
            if number and value.chunk_start_offset < self.holes[number - 1].end:
                self._told_of_holes.append((self.holes[number - 1], value))
        elif record.opcode == Opcode.FOOTER:
            self._footer = stretch

    def _declare(self, opcode, record):
        """Note a schema or a channel; of two of one id, the first one counts that is sound."""
        key = _id_of(record)
        known = self.declared.get((opcode, key))
        if known is None:
            self._set_declared(opcode, key, record)
        elif known != record and opcode == Opcode.CHANNEL and (
                _has_sound_qos(record) and not _has_sound_qos(known)):
            self._set_declared(opcode, key, record)
            self._is_misdeclared, self.is_cut = True, False

    def _set_declared(self, opcode, key, record):
        self.declared[opcode, key] = record
        if opcode == Opcode.CHANNEL:
            self._schema_of[key] = int.from_bytes(record[HEAD.size + 2:HEAD.size + 4], 'little')

    def _correct_declared(self):
        """Let what stands at the end of the file, under its checksum, count."""
        for (opcode, key), record in self._declared_again.items():
            if self.declared[opcode, key] != record:
                self._set_declared(opcode, key, record)
                self._is_misdeclared, self.is_cut = True, False

    def _count(self, counts, first_ns, last_ns):
        """Take in messages, {channel: how many}."""
        if not counts:
            return
        self.counts.update(counts)
        self.first_ns = first_ns if self.first_ns is None else min(self.first_ns, first_ns)
        self.last_ns = last_ns if self.last_ns is None else max(self.last_ns, last_ns)
        if self.holes and self.holes[-1].last_ns is None:
            self.holes[-1].last_ns = first_ns

    def _look_up(self):
        """Take in what the index of chunks tells of those that are missing."""
        for hole, told in self._told_of_holes:
            heads = INDEX_HEAD.size * len(told.message_index_offsets)
            hole.is_told((told.message_index_length - heads) // ENTRY_SIZE,
                         told.message_start_time, told.message_end_time)

    def _look_for_more(self):
        """Add what is missing although no hole shows it."""
        for channel in self.counts.keys() - self.described:
            self.holes.append(Hole(Damage(
                0, 0, f'the description of channel {channel} is damaged',
                messages=self.counts[channel])))
        if self._is_summary_sound and self._told and not any(
                hole.messages is None for hole in self.holes):
            known = self.messages + sum(hole.messages for hole in self.holes)
            if self._told.message_count > known:
                self.holes.append(Hole(Damage(0, 0, 'the file says that it holds more messages',
                                              messages=self._told.message_count - known)))

    def _look_at_end(self):
        """Note whether the file is finished as it has to be, and the summary what it was."""
        if self._footer is None or self._is_summary_damaged:
            return
        record, footer = self._footer
        self._stream.seek(record.end)
        if self._stream.read(len(MAGIC) + 1) != MAGIC:
            return
        start, told = footer.summary_start, footer.summary_crc
        if not start or not told:
            self._has_good_end = start <= record.start and not told
            self._is_summary_sound = bool(start) and self._has_good_end
            return
        # What was damaged may have become longer, or shorter: then it lies elsewhere.
        for at in (start, self._end_of_data):
            if not self._is_summary_sound and at <= record.start:
                crc = 0
                for portion in portions(self._stream, at, record.start + HEAD.size + _COVERED):
                    crc = crc32(portion, crc)
                self._is_summary_sound = crc == told
                self._has_good_end = self._is_summary_sound and at == start


def whole(stream: BinaryIO, record: Record) -> bytes:
    """Return a record with its head."""
    stream.seek(record.start)
    return stream.read(record.end - record.start)


def _id_of(declared: bytes) -> int:
    """Return the id of a schema or a channel, a whole record."""
    return int.from_bytes(declared[HEAD.size:HEAD.size + 2], 'little')


def _has_sound_qos(channel: bytes) -> bool:
    """Tell whether a channel, a whole record, has no quality of service, or one to be read."""
    try:
        found = records.Channel.read(ReadDataStream(BytesIO(channel[HEAD.size:])))
    except (McapError, struct.error, UnicodeDecodeError):
        return False
    text = found.metadata.get('offered_qos_profiles', '')
    return not text or offered(text) is not None


def message_head(stream: BinaryIO, record: Record) -> tuple[int, int]:
    """Return channel and log time of a message."""
    stream.seek(record.start + HEAD.size)
    channel, _, log_ns, _ = MESSAGE.unpack(stream.read(MESSAGE.size))
    return channel, log_ns


def declared_in(chunk: WholeChunk) -> Iterator[tuple[Opcode, bytes]]:
    """Yield the schemas and channels that a chunk holds, as whole records."""
    for at in chunk.records.others:
        opcode, length = HEAD.unpack_from(chunk.data, at)
        if opcode in (Opcode.SCHEMA, Opcode.CHANNEL):
            yield Opcode(opcode), chunk.data[at:at + HEAD.size + length]
