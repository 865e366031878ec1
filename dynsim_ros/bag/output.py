# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A file that grows by whole writes only, even on a full disk, and is locked meanwhile."""

from __future__ import annotations

from contextlib import suppress
import errno
import fcntl
import os

_NEW = os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC
_sync = getattr(os, 'fdatasync', os.fsync)


class Output:
    """
    What an MCAP file is written to: unbuffered, and a write that fails leaves nothing behind.

    An MCAP file that ends between two records is readable up to there. The lock tells others that
    a process which lives writes the file; it ends with the process, whatever becomes of that.
    """

    def __init__(self, path: str | os.PathLike, folder: int | None = None):
        """
        Create the file; raises FileExistsError rather than overwrite one, or follow a link.

        folder: descriptor of the folder that it lies in, None where the path is enough.
        """
        self._path = os.fspath(path)
        name = self._path if folder is None else os.path.basename(self._path)
        try:
            self._file = os.open(name, _NEW, 0o666, dir_fd=folder)
        except OSError as error:
            raise OSError(error.errno, error.strerror, self._path) from None
        self._begin(0)
        # Who looks whether the file has to be recovered lets it go at once, as it is empty.
        with suppress(OSError):
            fcntl.flock(self._file, fcntl.LOCK_EX)

    @classmethod
    def go_on(cls, path: str | os.PathLike, file: int, size: int) -> Output:
        """Return an Output that appends to an open, locked file, behind its first bytes."""
        output = cls.__new__(cls)
        output._path, output._file = os.fspath(path), file
        output._begin(size)
        output.cut(size)
        return output

    def _begin(self, size):
        self._size = size
        # There are file systems that do not count names.
        self._has_name = os.fstat(self._file).st_nlink > 0

    def write(self, data: bytes) -> int:
        """Append all of the data, or none of them and raise OSError."""
        if self._has_name and os.fstat(self._file).st_nlink == 0:
            raise OSError(errno.ENOENT, 'it has been deleted', self._path)
        rest, end = memoryview(data), self._size
        try:
            while rest:
                count = os.pwrite(self._file, rest, end)
                rest, end = rest[count:], end + count
        except OSError:
            self.cut(self._size)
            raise
        self._size = end
        return len(data)

    def cut(self, size: int):
        """Take back what was written beyond a size."""
        self._size = size
        # Where even this fails, the next write goes to the right place all the same.
        with suppress(OSError):
            os.ftruncate(self._file, size)

    def tell(self) -> int:
        """Return the number of bytes written."""
        return self._size

    def sync(self):
        """Wait until all that was written is on the disk."""
        _sync(self._file)

    def close(self):
        """Close the file and give up the lock; harmless when repeated."""
        if self._file >= 0:
            os.close(self._file)
            self._file = -1


def sync_folder(path: str | os.PathLike):
    """Wait until the names in a folder are on the disk, where the file system can tell."""
    folder = os.open(path, os.O_RDONLY | os.O_DIRECTORY)
    try:
        with suppress(OSError):
            os.fsync(folder)
    finally:
        os.close(folder)
