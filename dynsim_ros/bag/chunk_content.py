# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What an MCAP chunk holds: opened with bounded memory, whatever the file says of its size."""

from __future__ import annotations

from io import BytesIO
import struct
from typing import NamedTuple

import lz4.frame
import zstandard

from .checksum import crc32

# Chunks that hold more are not opened [bytes]; usual ones hold about a million.
LARGEST_CHUNK = 256 * 1024 * 1024

# First and last log time, size and checksum of the content, length of the compression's name;
# behind that name stands how long the data are that follow.
_HEAD = struct.Struct('<QQQII')
_LENGTH = struct.Struct('<Q')
_LONGEST_NAME = 16


class DamagedChunk(ValueError):
    """A chunk that cannot be decompressed, or whose checksum or records do not fit."""


class ChunkHead(NamedTuple):
    """
    What a chunk record says of itself: first and last log time; size and CRC32 of its content.

    compression: 'zstd', 'lz4' or '' for none; start: where the data begin in the record's content;
    length: how many bytes they are.
    """

    start_ns: int
    end_ns: int
    size: int
    crc: int
    compression: str
    start: int
    length: int


def read_head(content: bytes) -> ChunkHead:
    """Return the head of a chunk, from the content of its record, cut off behind it or not."""
    try:
        *numbers, name = _HEAD.unpack_from(content)
        start = _HEAD.size + name
        if name > _LONGEST_NAME:
            raise DamagedChunk('its head does not fit')
        compression = bytes(content[_HEAD.size:start]).decode('ascii')
        (length,) = _LENGTH.unpack_from(content, start)
    except (struct.error, UnicodeDecodeError):
        raise DamagedChunk('its head does not fit') from None
    return ChunkHead(*numbers, compression, start + _LENGTH.size, length)


def open_chunk(content: bytes) -> bytes:
    """Return the records that a chunk record holds, decompressed; raises DamagedChunk."""
    head = read_head(content)
    if head.start + head.length != len(content):
        raise DamagedChunk('its head does not fit')
    data = decompress(head.compression, content[head.start:], head.size)
    if head.crc and crc32(data) != head.crc:
        raise DamagedChunk('its checksum is wrong')
    return data


def decompress(compression: str, data: bytes, size: int) -> bytes:
    """Return data decompressed, which have to be of some size then; raises DamagedChunk."""
    if size > LARGEST_CHUNK:
        raise DamagedChunk(f'it says that it holds {size} bytes, more than the {LARGEST_CHUNK} '
                           'that are opened')
    try:
        if compression == 'zstd':
            # A frame may say a size of its own, and that would be allocated.
            told = zstandard.get_frame_parameters(data).content_size
            found = data[:0] if told not in (size, zstandard.CONTENTSIZE_UNKNOWN) else (
                zstandard.ZstdDecompressor().decompress(data, max_output_size=size))
        elif compression == 'lz4':
            frame = lz4.frame.LZ4FrameDecompressor()
            found = frame.decompress(bytes(data), max_length=size + 1)
            if not frame.eof:
                raise DamagedChunk('it cannot be decompressed: it has no end')
        else:
            found = _up_to(compression, data, size + 1)
    except (zstandard.ZstdError, RuntimeError, MemoryError) as error:
        raise DamagedChunk(f'it cannot be decompressed: {error}') from None
    if len(found) != size:
        raise DamagedChunk('its size is not what it says')
    return found


def open_part(content: bytes) -> bytes:
    """Return what can be had of the records of a chunk that is cut off; raises DamagedChunk."""
    head = read_head(content)
    try:
        return _up_to(head.compression, content[head.start:], min(head.size, LARGEST_CHUNK))
    except (zstandard.ZstdError, RuntimeError, MemoryError):
        return b''


def _up_to(compression: str, data: bytes, size: int) -> bytes:
    """Return the first so many bytes of data decompressed."""
    if compression == 'zstd':
        return zstandard.ZstdDecompressor().stream_reader(BytesIO(data)).read(size)
    if compression == 'lz4':
        return lz4.frame.LZ4FrameDecompressor().decompress(bytes(data), max_length=size)
    if compression:
        raise DamagedChunk(f"its compression '{compression}' is not known")
    return data[:size]
