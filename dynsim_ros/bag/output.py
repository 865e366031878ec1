# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A new file whose content always ends with a whole write, also when the disk is full."""

from __future__ import annotations

import os


class Output:
    """
    A stream for an MCAP writer: unbuffered, and a write that fails leaves nothing behind.

    An MCAP file that ends between two records is readable up to there.
    """

    def __init__(self, path: str | os.PathLike):
        """Create the file; raises FileExistsError rather than overwrite one."""
        self._file = open(path, 'xb', buffering=0)
        self._size = 0

    def write(self, data: bytes) -> int:
        """Append all of the data, or none of them and raise OSError."""
        rest = memoryview(data)
        try:
            while rest:
                rest = rest[self._file.write(rest):]
        except OSError:
            self._file.truncate(self._size)
            self._file.seek(self._size)
            raise
        self._size += len(data)
        return len(data)

    def tell(self) -> int:
        """Return the number of bytes written."""
        return self._size

    def flush(self):
        """Do nothing: every write has already gone to the operating system."""

    def close(self):
        """Close the file."""
        self._file.close()
