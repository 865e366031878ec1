# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The files of a bag: one MCAP file, or those that a rosbag2 folder names."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
import tempfile
from typing import BinaryIO, NamedTuple

import yaml
import zstandard

from .index import Index, read_index
from .records import MAGIC


class BagError(ValueError):
    """A bag that cannot be opened; one line of text."""


class Source(NamedTuple):
    """A file of a bag; unpack turns a stored message into the one that was published."""

    path: Path
    stream: BinaryIO
    index: Index
    unpack: Callable[[bytes], bytes] | None = None


def open_sources(path: Path) -> list[Source]:
    """Return the files of a bag in order; raises BagError, in one line, for what is none."""
    try:
        if path.is_dir():
            return _open_folder(path)
        return [_open_file(path)]
    except OSError as error:
        raise BagError(f'{error.filename or path}: {error.strerror or error}') from None


def _open_folder(folder: Path) -> list[Source]:
    """Return the files that a rosbag2 folder's metadata.yaml names."""
    described = folder / 'metadata.yaml'
    if not described.is_file():
        raise BagError(f'{folder} is a folder without metadata.yaml, not a bag: name an .mcap '
                       'file or the folder of a rosbag2 recording')
    try:
        about = yaml.safe_load(described.read_text(encoding='utf-8'))[
            'rosbag2_bagfile_information']
        storage, names = about['storage_identifier'], list(about['relative_file_paths'])
        mode = str(about.get('compression_mode') or '').lower()
        packed = mode == 'message' and about.get('compression_format') == 'zstd'
    except (yaml.YAMLError, UnicodeDecodeError, KeyError, TypeError, AttributeError):
        raise BagError(f'{described} does not describe a rosbag2 recording') from None
    if storage != 'mcap':
        raise BagError(f"{folder} is stored as '{storage}', only 'mcap' can be read: convert it "
                       'with "ros2 bag convert"')
    if not names:
        raise BagError(f'{described} names no file')
    unpack = zstandard.ZstdDecompressor().decompressobj if packed else None
    return [_open_file(folder / name, unpack and (lambda data: unpack().decompress(data)))
            for name in names]


def _open_file(path: Path, unpack: Callable[[bytes], bytes] | None = None) -> Source:
    """Open one MCAP file, also one that rosbag2 compressed as a whole."""
    stream = open(path, 'rb')
    try:
        if path.suffix == '.zstd':
            stream = _decompressed(path, stream)
        begin = stream.read(len(MAGIC))
        if not begin:
            raise BagError(f'{path} is empty')
        if begin != MAGIC:
            raise BagError(f'{path} is not an MCAP file')
        return Source(path, stream, read_index(stream), unpack)
    except BaseException:
        stream.close()
        raise


def _decompressed(path: Path, stream: BinaryIO) -> BinaryIO:
    """Return a nameless temporary file with the decompressed content; closes the stream."""
    whole = tempfile.TemporaryFile()
    try:
        with stream:
            zstandard.ZstdDecompressor().copy_stream(stream, whole)
    except zstandard.ZstdError as error:
        whole.close()
        raise BagError(f'{path} cannot be decompressed: {error}') from None
    whole.seek(0)
    return whole
