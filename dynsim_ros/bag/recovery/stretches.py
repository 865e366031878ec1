# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A file taken apart for recovery: chunks with their indexes, holes with what is known of them."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import BinaryIO

from mcap.opcode import Opcode
import numpy as np

from .intact import OpenChunk
from .search import Damage, Piece, Search
from ..chunk_content import DamagedChunk, open_part
from ..chunk_records import ChunkRecords, records_of
from ..records import HEAD, Record
from ..summary import ChunkPlace, ENTRY_SIZE, INDEX_HEAD


class WholeChunk:
    """
    A chunk that is whole.

    record: where it lies; data, records: its content; end: behind the indexes that follow it.
    """

    def __init__(self, record: Record, value: OpenChunk):
        """Begin without indexes."""
        self.record, self.head = record, value.head
        self.data, self.records = value.data, value.records
        self.end = record.end
        self._entries: dict[int, np.ndarray] = {}
        self._is_torn = False

    @cached_property
    def indexes(self) -> dict[int, bytes]:
        """Return {channel: its message index, a whole record}, as it ought to be."""
        return self.records.indexes()

    @property
    def lengths(self) -> dict[int, int]:
        """Return {channel: bytes} of the indexes that follow the chunk, in their order."""
        return {channel: INDEX_HEAD.size + ENTRY_SIZE * len(entries)
                for channel, entries in self._entries.items()}

    @property
    def is_right(self) -> bool:
        """Tell whether what tells of the chunk is what it ought to be; indexes may be absent."""
        return self.has_right_times and not self._is_torn and (
            not self._entries or self.has_all_indexes)

    @property
    def has_right_times(self) -> bool:
        """Tell whether it says itself of which time it is."""
        return (self.head.start_ns, self.head.end_ns) == self.records.times

    @property
    def has_all_indexes(self) -> bool:
        """Tell whether every message stands in an index that follows the chunk."""
        found = {channel: entries for channel, entries in self._entries.items() if len(entries)}
        return found.keys() == self.indexes.keys() and all(
            _are_same(entries, np.frombuffer(self.indexes[channel], '<u8', offset=INDEX_HEAD.size))
            for channel, entries in found.items())

    def add_index(self, record: Record, channel: int, entries: np.ndarray):
        """Take in an index that follows it."""
        self._entries[channel] = entries
        self.end = record.end

    def place(self, at: int) -> ChunkPlace:
        """Return what an index is to tell of the chunk, where it begins somewhere."""
        return ChunkPlace(at, *self.records.times, self.head.compression, self.head.length,
                          self.head.size, self.head.crc)

    def takes(self, damage: Damage) -> bool:
        """Tell whether damage behind the chunk concerns its indexes alone."""
        if damage.end > self.record.end + sum(map(len, self.indexes.values())):
            return False
        self.end = damage.end
        self._is_torn = True
        return True


class Hole:
    """
    A stretch of a file where nothing is intact.

    start, end: its bytes, 0 where they are not known; reason: one line; is_cut: see Damage;
    messages: how many were there, None where nothing tells; first_ns, last_ns: their log times,
    or those of what lies before and behind, or None.
    """

    def __init__(self, damage: Damage):
        """Take what is known of the damage itself."""
        self.start, self.end, self.reason = damage.start, damage.end, damage.reason
        self.head, self.is_cut = damage.head, damage.is_cut
        self.messages = damage.messages
        self._is_told = False
        self.first_ns: int | None = None
        self.last_ns: int | None = None
        if self.head is not None:
            self.first_ns, self.last_ns = self.head.start_ns, self.head.end_ns

    def add_index(self, record: Record, channel: int, entries: np.ndarray):
        """Take in the index of messages that were there."""
        if len(entries):
            self.count(len(entries), int(entries[:, 0].min()), int(entries[:, 0].max()))
        self.end = record.end

    def takes(self, damage: Damage) -> bool:
        """Tell whether damage belongs to this, and take it in then."""
        if damage.start != self.end or self.head is not None or damage.head is not None:
            return False
        self.end, self.is_cut, self.messages = damage.end, False, None
        return True

    def count(self, messages: int, first_ns: int, last_ns: int):
        """Take in that so many messages were there, from a time to another one."""
        if self.messages is None:
            self.messages, self.first_ns, self.last_ns = 0, first_ns, last_ns
        self.messages += messages
        self.first_ns, self.last_ns = min(self.first_ns, first_ns), max(self.last_ns, last_ns)

    def is_told(self, messages: int, first_ns: int, last_ns: int):
        """Take in likewise what the index of chunks says, which tells of all that was there."""
        if not self._is_told:
            self.messages = None
        self._is_told = True
        self.count(messages, first_ns, last_ns)

    def values(self) -> dict[str, str]:
        """Return what a metadata record tells of it, see Gap."""
        known = {'messages': self.messages, 'first_ns': self.first_ns, 'last_ns': self.last_ns}
        return {name: 'unknown' if value is None else str(value)
                for name, value in known.items()} | {'reason': self._where()}

    def __str__(self) -> str:
        """Return it as a part of a line."""
        if self.messages == 0:
            return f'no message is missing, but {self._where()}'
        count = 'messages' if self.messages is None else f'{self.messages} messages'
        times = [f'{word} {ns * 1e-9:.3f} s'
                 for word, ns in (('from', self.first_ns), ('to', self.last_ns))
                 if ns is not None]
        return ' '.join([count, *times, f'are missing: {self._where()}'])

    def _where(self):
        where = f' (bytes {self.start} to {self.end})' if self.end else ''
        return f'{self.reason}{where}'

    def remains(self, stream: BinaryIO) -> tuple[bytes, ChunkRecords] | None:
        """
        Return what can be had of a chunk that is cut off: its content, and messages in that.

        None of another one: its checksum is wrong, and nothing tells which message is.
        """
        if self.head is None or not self.is_cut:
            return None
        stream.seek(self.start + HEAD.size)
        try:
            data = open_part(stream.read(self.end - self.start - HEAD.size))
        except DamagedChunk:
            return None
        found = records_of(data).between(self.head.start_ns, self.head.end_ns)
        return (data, found) if len(found.messages) else None


def stretches(stream: BinaryIO, size: int) -> Iterator[Piece | WholeChunk | Hole]:
    """Yield what a file of so many bytes consists of; chunks and holes with what follows them."""
    held: WholeChunk | Hole | None = None
    for piece in Search(stream, size).pieces():
        if isinstance(piece, Damage):
            if isinstance(held, WholeChunk) and held.takes(piece):
                continue
            if isinstance(held, Hole) and held.takes(piece):
                continue
            following = Hole(piece)
        elif piece.record.opcode == Opcode.MESSAGE_INDEX:
            if held is None:
                # Of a chunk whose very opcode is another one.
                held = Hole(Damage(piece.record.start, piece.record.start, 'a chunk is damaged'))
            held.add_index(piece.record, *piece.value)
            continue
        elif piece.record.opcode == Opcode.CHUNK:
            following = WholeChunk(*piece)
        else:
            following = None
        if held is not None:
            yield held
        held = following
        if following is None:
            yield piece
    if held is not None:
        yield held


def _are_same(entries, others):
    """Tell whether two message indexes say the same, in whatever order."""
    others = others.reshape(-1, 2)
    if len(entries) != len(others):
        return False
    return bool((entries == others).all()) or bool((_sorted(entries) == _sorted(others)).all())


def _sorted(entries):
    return entries[np.lexsort((entries[:, 1], entries[:, 0]))]
