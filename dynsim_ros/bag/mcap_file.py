# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""An MCAP file written record by record."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
import os
from pathlib import Path

import lz4.frame
from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, Header, Metadata, Schema
import zstandard

from .checksum import crc32
from .mcap_chunk import Chunk
from .output import Output
from .records import MAGIC
from .summary import as_bytes, ChunkPlace, Summary, write_record


# Chosen by measuring bags of the scenes: zstd takes a third of the time of its usual level 3, for
# 12 % more bytes, and lz4 three quarters of that of its usual level, for fewer bytes. What repeats
# are names and times, what does not are numbers of eight bytes, that are passed in larger steps.
_ZSTD = zstandard.ZstdCompressionParameters(
    window_log=19, hash_log=12, chain_log=12, search_log=1, min_match=6, target_length=4,
    strategy=zstandard.STRATEGY_FAST)
_LZ4_LEVEL = -3


def compressor(compression: str) -> Callable[[bytes], bytes]:
    """Return what compresses bytes; compression: as MCAP names it."""
    if compression == 'zstd':
        return zstandard.ZstdCompressor(compression_params=_ZSTD).compress
    if compression == 'lz4':
        return partial(lz4.frame.compress, compression_level=_LZ4_LEVEL)
    return bytes


class McapFile:
    """
    A new MCAP file.

    Schemas and channels are written before the chunk in which they are used first. A call that
    raises OSError has left no trace, and may be made again.
    """

    def __init__(self, path: str | os.PathLike, compression: str, header: Header,
                 folder: int | None = None):
        """
        Create the file; raises FileExistsError if it exists.

        compression: as MCAP names it; folder: as Output takes it.
        """
        self._path, self._folder = Path(path), folder
        self._compression = compression
        self._compress = compressor(compression)
        self._summary: Summary | None = None
        self._output = Output(path, folder)
        try:
            self._summary = Summary(self._path.parent)
            self._output.write(MAGIC + as_bytes(header))
        except BaseException:
            self.discard()
            raise

    @property
    def size(self) -> int:
        """Return how many bytes the file will have, about, if it is finished now."""
        return self._output.tell() + self._summary.size

    def add_schema(self, name: str, encoding: str, data: bytes) -> int:
        """Declare a message type; return its id."""
        number = self._summary.count_of(Opcode.SCHEMA) + 1
        self.declare(Opcode.SCHEMA, as_bytes(Schema(number, data, encoding, name)))
        return number

    def add_channel(self, topic: str, schema_id: int, metadata: dict[str, str]) -> int:
        """Declare a topic of CDR messages; return its id."""
        number = self._summary.count_of(Opcode.CHANNEL) + 1
        self.declare(Opcode.CHANNEL,
                     as_bytes(Channel(number, topic, 'cdr', metadata, schema_id)))
        return number

    def declare(self, opcode: Opcode, record: bytes):
        """Append a schema or a channel, a whole record."""
        self._output.write(record)
        self._summary.note_declared(opcode, record)

    def add(self, record: Metadata | Attachment):
        """Append a metadata record or an attachment."""
        write_record(self._output, self._summary, record)

    def add_chunk(self, chunk: Chunk):
        """Append the messages of a chunk with their indexes, in one write."""
        content, indexes = chunk.content(), chunk.indexes()
        data = self._compress(content)
        place = ChunkPlace(self._output.tell(), chunk.start_ns, chunk.end_ns, self._compression,
                           len(data), len(content), crc32(content))
        self._output.write(b''.join((place.head(), data, *indexes.values())))
        self._summary.note_chunk(
            place, {channel: len(index) for channel, index in indexes.items()})

    def sync(self):
        """Wait until all that was written is on the disk."""
        self._output.sync()

    def finish(self):
        """Append the summary."""
        self._summary.write(self._output)

    def close(self):
        """Close the file."""
        self._output.close()
        if self._summary is not None:
            self._summary.close()

    def discard(self):
        """Close the file, and delete it."""
        self.close()
        os.unlink(self._path if self._folder is None else self._path.name, dir_fd=self._folder)
