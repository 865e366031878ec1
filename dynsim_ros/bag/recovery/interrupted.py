# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which bags of this package in a folder are not finished, although nobody writes them."""

from __future__ import annotations

import fcntl
from io import BytesIO
import os
from pathlib import Path
import stat

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Header

from ..records import HEAD, MAGIC

# More than the head of a bag of ours takes [bytes].
_BEGINNING = 1024
_LIBRARY = 'dynsim_ros '


def interrupted_bags(folder: str | os.PathLike) -> list[Path]:
    """Return the paths of bags to be recovered, oldest name first; nothing is changed."""
    try:
        names = sorted(name for name in os.listdir(folder) if name.endswith('.mcap'))
    except OSError:
        return []
    return [path for path in (Path(folder, name) for name in names) if _is_interrupted(path)]


def _is_interrupted(path):
    """Tell whether a file is a bag of ours that is not finished, and that nobody has open."""
    try:
        file = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
    except OSError:
        return False
    try:
        found = os.fstat(file)
        if not stat.S_ISREG(found.st_mode) or found.st_uid != os.geteuid():
            return False
        if os.pread(file, len(MAGIC), max(found.st_size - len(MAGIC), 0)) == MAGIC and (
                found.st_size > len(MAGIC)):
            return False
        if not _is_ours(os.pread(file, _BEGINNING, 0)):
            return False
        fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except OSError:
        return False
    finally:
        os.close(file)
    return True


def _is_ours(beginning):
    """Tell whether a file that begins so was written by this package."""
    if len(beginning) < len(MAGIC) + HEAD.size or not beginning.startswith(MAGIC):
        return False
    opcode, length = HEAD.unpack_from(beginning, len(MAGIC))
    start = len(MAGIC) + HEAD.size
    if opcode != Opcode.HEADER or start + length > len(beginning):
        return False
    try:
        header = Header.read(ReadDataStream(BytesIO(beginning[start:start + length])))
    except (McapError, UnicodeDecodeError, ValueError):
        return False
    return header.library.startswith(_LIBRARY)
