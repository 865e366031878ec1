# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""All records of an MCAP file that are whole, also behind places where it is damaged."""

from __future__ import annotations

from collections.abc import Iterator
import re
from typing import Any, BinaryIO, NamedTuple

from mcap.opcode import Opcode

from .intact import chunk_head, NotIntact, parsed, PRIVATE
from ..chunk_content import ChunkHead, LARGEST_CHUNK
from ..records import HEAD, MAGIC, Record

# What a record can begin with: a known opcode, and a length of less than 4 GiB.
_BEGINNING = re.compile(rb'(?=[\x01-\x0f].{4}\0\0\0\0)', re.DOTALL)
# Likewise a chunk, the index of messages behind one, or what tells of one at the end.
_CHUNK_BEGINNING = re.compile(rb'(?=[\x06-\x08].{4}\0\0\0\0)', re.DOTALL)
_WINDOW = 256 * 1024
# Between two damaged places a message, which has no checksum, is taken for one if so many records
# stand there one behind the other.
_CHAIN, _LONGEST_CHAIN = 4, 16
# The search gives up after having looked in vain at so many bytes for each byte of the file.
_EFFORT, _LEAST_EFFORT = 16, 64 * 1024 * 1024


class Piece(NamedTuple):
    """A record that is whole, and what it says, see intact.parsed."""

    record: Record
    value: Any


class Damage(NamedTuple):
    """
    A stretch of a file where no record is whole: first byte, end, and what was found there.

    head: of a chunk that stands there, if that much is known. is_cut: whether it is the beginning
    of a record, at the end of the file. messages: how many it held, None where that is not known.
    """

    start: int
    end: int
    reason: str
    head: ChunkHead | None = None
    is_cut: bool = False
    messages: int | None = None


class Search:
    """Goes through a file; the effort is bounded whatever is in it."""

    def __init__(self, stream: BinaryIO, size: int):
        """Begin at the beginning of a file of so many bytes."""
        self._stream = stream
        self._size = size
        stream.seek(max(size - len(MAGIC), 0))
        # A file that has its end is not cut off, even if a record seems to be.
        self._may_be_cut = stream.read() != MAGIC
        self._effort = _LEAST_EFFORT + _EFFORT * size
        # None as long as neither a chunk nor a message outside one was met.
        self._has_chunks: bool | None = None
        self._is_behind_damage = False

    def pieces(self) -> Iterator[Piece | Damage]:
        """Yield what the file consists of, in order; ends behind the footer."""
        self._stream.seek(0)
        at = len(MAGIC)
        if self._stream.read(at) != MAGIC:
            if self._is_whole(at):
                yield Damage(0, at, 'the beginning of the file is damaged', messages=0)
            else:
                at = 0
        while at < self._size:
            try:
                piece = self._piece(at)
                self._check_place(piece.record)
            except NotIntact as error:
                self._effort -= error.cost
                damage = self._damage(at, str(error))
                yield damage
                at = damage.end
                self._is_behind_damage = True
                continue
            yield piece
            at = piece.record.end
            if piece.record.opcode == Opcode.FOOTER:
                break

    def _check_place(self, record: Record):
        """Raise NotIntact for a message that is none where it stands."""
        if record.opcode == Opcode.CHUNK:
            self._has_chunks, self._is_behind_damage = True, False
        if record.opcode != Opcode.MESSAGE and record.opcode < PRIVATE:
            return
        if not self._is_followed(record.end):
            raise NotIntact('no record follows it')
        if record.opcode >= PRIVATE:
            return
        if self._has_chunks is None:
            self._has_chunks = (self._is_behind_damage
                                and self._next(record.end, _CHUNK_BEGINNING) < self._size)
        # What is left of a chunk has no checksum any more: some of it may be damaged, too.
        if self._is_behind_damage and self._has_chunks:
            raise NotIntact('a chunk is damaged')

    def _record(self, at: int) -> Record:
        """Return the record that begins somewhere, whole or not; raises NotIntact if none does."""
        self._stream.seek(at)
        head = self._stream.read(HEAD.size)
        if len(head) < HEAD.size:
            raise NotIntact('the file ends in the middle of a record')
        opcode, length = HEAD.unpack(head)
        if opcode == 0:
            raise NotIntact('there is no record')
        return Record(opcode, at, at + HEAD.size + length)

    def _piece(self, at: int) -> Piece:
        """Return the record that begins somewhere; raises NotIntact."""
        record = self._record(at)
        if record.end > self._size:
            what = 'chunk' if record.opcode == Opcode.CHUNK else 'record'
            raise NotIntact(f'the file ends in the middle of a {what}')
        return Piece(record, parsed(record, self._stream))

    def _damage(self, at: int, reason: str) -> Damage:
        """Return how far it goes from here to the next record that is whole."""
        head, is_cut = None, self._may_be_cut and at + HEAD.size > self._size
        try:
            record = self._record(at)
            if record.opcode == Opcode.CHUNK:
                head = chunk_head(record, self._stream)
            is_cut = (self._may_be_cut and record.end > self._size
                      and record.opcode <= Opcode.DATA_END)
            if is_cut and head is not None:
                return Damage(at, self._size, reason, head, True)
            if record.end <= self._size and self._is_whole(record.end):
                return Damage(at, record.end, reason, head)
        except NotIntact:
            pass
        end = self._next(at + 1)
        return Damage(at, end, reason, is_cut=is_cut and end == self._size)

    def _next(self, at: int, beginning: re.Pattern = _BEGINNING) -> int:
        """Return where the next record that is whole begins, or the end of the file."""
        while at < self._size and self._effort >= 0:
            self._stream.seek(at)
            window = self._stream.read(_WINDOW + HEAD.size - 1)
            for match in beginning.finditer(window):
                if self._effort >= 0 and self._is_whole(at + match.start(), _CHAIN):
                    return at + match.start()
            at += _WINDOW
        return self._size

    def _is_whole(self, at: int, chain: int = 1) -> bool:
        """
        Tell whether so many records stand here; one with a checksum is enough.

        One for private use, of which nothing can be checked, tells as much as what follows it.
        """
        for _ in range(_LONGEST_CHAIN):
            if chain <= 0 or at >= self._size:
                break
            try:
                piece = self._piece(at)
            except NotIntact as error:
                self._effort -= error.cost + HEAD.size
                return False
            if piece.record.opcode in (Opcode.CHUNK, Opcode.FOOTER):
                break
            if piece.record.opcode != Opcode.MESSAGE:
                self._effort -= piece.record.end - at
            at = piece.record.end
            chain -= piece.record.opcode < PRIVATE
        return True

    def _is_followed(self, at: int) -> bool:
        """Tell whether a record stands here, or the beginning of one that is cut off."""
        if at + HEAD.size > self._size or self._is_whole(at):
            return True
        try:
            record = self._record(at)
        except NotIntact:
            return False
        return (self._may_be_cut and self._size < record.end < at + LARGEST_CHUNK
                and record.opcode <= Opcode.DATA_END)
