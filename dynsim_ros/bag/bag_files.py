# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The files of one bag: where they go, and when the next one begins."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
import os
from pathlib import Path

from .bag_names import next_part
from .writer import BagWriter

PART_METADATA = 'part'


@dataclass(frozen=True)
class Limits:
    """
    How large a file becomes before the next one begins.

    size: in bytes, about; duration_ns: of what is in it; None for any.
    """

    size: float | None = None
    duration_ns: int | None = None

    @property
    def are_set(self) -> bool:
        """Tell whether there are any."""
        return not (self.size is None and self.duration_ns is None)


NO_LIMITS = Limits()


class BagFiles:
    """
    Makes the files of a bag, all in one folder, whatever becomes of its name meanwhile.

    limits: Limits; describe(writer, *of): writes down into a new file what it is to begin with.
    """

    def __init__(self, folder: Path, compression: str, library: str, limits: Limits,
                 describe: Callable):
        """Make the folder if it is not there; raises OSError."""
        folder.mkdir(parents=True, exist_ok=True)
        self._folder = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        self._compression, self._library = compression, library
        self._describe = describe
        self.limits = limits
        self._asked = 1
        self._since_ns: int | None = None

    def begin(self, path: Path, *of, part: int = 1) -> BagWriter:
        """Return the writer of a new file, which is described."""
        writer = BagWriter(path, compression=self._compression, library=self._library,
                           folder=self._folder)
        try:
            self._describe(writer, *of)
            if self.limits.are_set:
                writer.add_metadata(PART_METADATA, {'number': str(part)})
        except BaseException:
            writer.discard()
            raise
        return writer

    def is_next_due(self, stamp_ns: int, recorder) -> bool:
        """Tell whether the present file has become long, or large, enough at a time."""
        limits = self.limits
        if not limits.are_set:
            return False
        if self._since_ns is None:
            self._since_ns = stamp_ns
        if limits.duration_ns is not None and stamp_ns >= self._since_ns + limits.duration_ns:
            return True
        # As long as the next one that was asked for has not begun, it is not full.
        return (limits.size is not None and len(recorder.paths) == self._asked
                and recorder.size >= limits.size)

    def go_on(self, stamp_ns: int, recorder, *of):
        """Have the next file begin, described, with what the recorder is handed from here on."""
        self._asked += 1
        self._since_ns = stamp_ns
        part = self._asked
        recorder.go_on_in(lambda: self.begin(next_part(recorder.path), *of, part=part))

    def close(self):
        """Make no more files; harmless when repeated."""
        if self._folder >= 0:
            os.close(self._folder)
            self._folder = -1
