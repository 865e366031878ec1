# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bags written as MCAP files that ros2 bag, Foxglove, mcap and rosbags open."""

from __future__ import annotations

from collections.abc import Mapping
import os
from pathlib import Path

import numpy as np

from .mcap_chunk import Chunk
from .mcap_file import McapFile
from .pack_rows import RowPlan
from ..messages.definitions import definition
from ..messages.qos import Qos, STATE

# As MCAP names them.
COMPRESSIONS = {'zstd': 'zstd', 'lz4': 'lz4', 'none': ''}

# Messages of about so many bytes are compressed and indexed together.
CHUNK_SIZE = 256 * 1024


class BagWriter:
    """
    Writes messages, already CDR bytes, into a new MCAP file.

    Channels may be added at any time. Times are integer nanoseconds and must not go back.
    message_count: messages that are in the file or in the chunk in progress. Used as a context
    manager it closes the file. After an OSError no more can be written; everything up to the
    last whole chunk stays in the file.
    """

    def __init__(self, path: str | os.PathLike, *, compression: str = 'zstd',
                 chunk_size: int = CHUNK_SIZE, library: str = 'dynsim_ros'):
        """
        Create the file; raises FileExistsError if it exists.

        compression: 'zstd', 'lz4' or 'none'; chunk_size: bytes before compression after which
        a chunk is written; library: name and version of the writing program.
        """
        if compression not in COMPRESSIONS:
            raise ValueError(f"compression '{compression}' is unknown: use one of "
                             + ', '.join(COMPRESSIONS))
        if chunk_size < 1:
            raise ValueError(f'chunk size {chunk_size} bytes is less than 1 byte')
        self.path = Path(path)
        self.message_count = 0
        self._last_stamp = 0
        self._schemas: dict[str, int] = {}
        self._failed = False
        self._chunk = Chunk(chunk_size)
        self._file: McapFile | None = McapFile(self.path, COMPRESSIONS[compression], library)

    @property
    def pending(self) -> int:
        """Return the number of messages in the chunk in progress, not yet in the file."""
        return self._chunk.count

    @property
    def pending_bytes(self) -> int:
        """Return how many bytes these are, before compression."""
        return self._chunk.size

    def add_channel(self, topic: str, type_name: str, qos: Qos = STATE) -> int:
        """Declare a topic of an installed message type; return the id to write to it with."""
        described = definition(type_name)
        if type_name not in self._schemas:
            self._schemas[type_name] = self._file.add_schema(
                type_name, 'ros2msg', described.text.encode())
        metadata = {'offered_qos_profiles': qos.offered_qos_profiles()}
        if described.type_hash:
            metadata['topic_type_hash'] = described.type_hash
        return self._file.add_channel(topic, self._schemas[type_name], metadata)

    def write(self, channel_id: int, stamp_ns: int, data: bytes):
        """Append a message at a time in ns; raises ValueError for a time before the last one."""
        self._check_usable()
        self._advance(stamp_ns, stamp_ns)
        self._chunk.add(channel_id, stamp_ns, data)
        self.message_count += 1
        if self._chunk.size >= self._chunk.capacity:
            self.flush()

    def declare_rows(self, plan: RowPlan):
        """Let ticks with such rows be written; once."""
        self._chunk.declare_rows(plan)

    def write_rows(self, blocks: np.ndarray, stamps: np.ndarray):
        """Append the rows of ticks: blocks (ticks, bytes) uint8, stamps (ticks,) [ns]."""
        self._check_usable()
        if (np.diff(stamps) < 0).any():
            raise ValueError(f'{self.path}: times in a bag never go back')
        self._advance(int(stamps[0]), int(stamps[-1]))
        while len(blocks):
            ticks, messages = self._chunk.add_rows(blocks, stamps)
            self.message_count += messages
            blocks, stamps = blocks[ticks:], stamps[ticks:]
            if len(blocks) or self._chunk.size >= self._chunk.capacity:
                self.flush()

    def add_metadata(self, name: str, values: Mapping[str, str]):
        """Append a record of names and texts, such as the settings of the run."""
        if name == 'rosbag2':
            raise ValueError("a metadata record must not be named 'rosbag2': ros2 bag would "
                             'take it for its own')
        self._check_usable()
        self._guarded(self._file.add_metadata, name, dict(values))

    def add_attachment(self, name: str, data: bytes, media_type: str):
        """Append a whole file, such as the scene, under a name."""
        self._check_usable()
        self._guarded(self._file.add_attachment, name, data, media_type, self._last_stamp)

    def flush(self):
        """End the chunk in progress and hand it to the operating system."""
        self._check_usable()
        if self._chunk.count:
            self._guarded(self._file.add_chunk, self._chunk)
            self._chunk.clear()

    def close(self):
        """Finish the file with its index and close it; harmless when called again."""
        if self._file is None:
            return
        try:
            if not self._failed:
                self.flush()
                self._guarded(self._file.finish)
        finally:
            self._file.close()
            self._file = None

    def __enter__(self) -> BagWriter:
        """Return the writer."""
        return self

    def __exit__(self, *_):
        """Close the file."""
        self.close()

    def _advance(self, first_ns, last_ns):
        """Go on from the last time to another one; raise ValueError for a time before it."""
        if first_ns < self._last_stamp:
            raise ValueError(f'{self.path}: a message at {first_ns} ns cannot follow one at '
                             f'{self._last_stamp} ns: times in a bag never go back')
        self._last_stamp = last_ns

    def _guarded(self, call, *arguments, **named):
        """Call into the file; after a failed write nothing more is to be added to it."""
        try:
            call(*arguments, **named)
        except OSError:
            self._failed = True
            self.message_count -= self._chunk.count
            self._chunk.clear()
            raise

    def _check_usable(self):
        """Raise ValueError when the file is closed or a write has failed."""
        if self._file is None or self._failed:
            reason = 'is closed' if self._file is None else 'could not be written'
            raise ValueError(f'{self.path} {reason}: no more can be added to it')
