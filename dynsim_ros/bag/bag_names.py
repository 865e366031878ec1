# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Names of new bags: the scene, the time, and which part it is where there are several."""

from __future__ import annotations

from collections.abc import Iterable
from datetime import datetime
import errno
import os
from pathlib import Path
import re

_PART = re.compile(r'_part(\d{4,})$')
# A file system takes 255 bytes; the time and what else comes behind need some.
_LONGEST = 160


def new_path(directory: str | os.PathLike, scene_name: str, in_parts: bool = False) -> Path:
    """Return a path for a new bag, or its first part: nothing of that name is there yet."""
    # A scene may have any name; what is no part of a file name is left out.
    name = re.sub(r'[^\w-]+', '_', scene_name).encode()[:_LONGEST].decode(errors='ignore')
    stem = f'{name}_{datetime.now():%Y%m%d_%H%M%S}'
    part = '_part0001' if in_parts else ''
    return first_free(Path(directory, f'{stem}{suffix}{part}.mcap').expanduser()
                      for suffix in ('', *(f'_{i}' for i in range(2, 1000))))


def next_part(path: Path) -> Path:
    """Return a path for the part of a bag that follows one; sorted by name they are in order."""
    number = int(_PART.search(path.stem).group(1))
    stem = _PART.sub('', path.stem)
    return first_free(path.with_name(f'{stem}_part{i:04}{path.suffix}')
                      for i in range(number + 1, number + 1000))


def first_free(paths: Iterable[Path]) -> Path:
    """Return the first path where nothing is, not even a link to nowhere."""
    for path in paths:
        if not os.path.lexists(path):
            return path
    raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(path))
