# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bags written as MCAP files that ros2 bag, Foxglove, mcap and rosbags open."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
import os
from pathlib import Path

from mcap.records import Attachment, Header, Metadata
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
    manager it closes the file. A call that raises OSError, as where the disk is full, has left no
    trace and may be made again; the chunk in progress is kept until it can be written.
    """

    def __init__(self, path: str | os.PathLike, *, compression: str = 'zstd',
                 chunk_size: int = CHUNK_SIZE, library: str = 'dynsim_ros',
                 folder: int | None = None):
        """
        Create the file; raises FileExistsError if it exists.

        compression: 'zstd', 'lz4' or 'none'; chunk_size: bytes before compression after which
        a chunk is written; library: name and version of the writing program; folder: descriptor
        of the folder that the file lies in, None where the path is enough.
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
        self._chunk = Chunk(chunk_size)
        self._file: McapFile | None = McapFile(
            self.path, COMPRESSIONS[compression], Header('ros2', library), folder)

    @property
    def size(self) -> int:
        """Return how many bytes the file will have, about, if it is finished now."""
        return self._file.size + self._chunk.size if self._file else 0

    @property
    def pending(self) -> int:
        """Return the number of messages in the chunk in progress, not yet in the file."""
        return self._chunk.count

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
        self.write_all(stamp_ns, [(channel_id, data)])

    def write_all(self, stamp_ns: int, messages: Iterable[tuple[int, bytes]]):
        """Append the messages of one instant, as (channel id, CDR bytes), likewise."""
        self._check_time(stamp_ns)
        self._make_room()
        self._last_stamp = stamp_ns
        for channel_id, data in messages:
            self._chunk.add(channel_id, stamp_ns, data)
            self.message_count += 1

    def declare_rows(self, plan: RowPlan):
        """Let ticks with such rows be written; once."""
        self._chunk.declare_rows(plan)

    def write_rows(self, blocks: np.ndarray, stamps: np.ndarray) -> int:
        """
        Append the rows of the first of some ticks; return of how many, one at least.

        blocks: (ticks, bytes) uint8; stamps: (ticks,) [ns].
        """
        if (stamps[1:] < stamps[:-1]).any():
            raise ValueError(f'{self.path}: times in a bag never go back')
        self._check_time(int(stamps[0]))
        self._make_room()
        ticks, messages = self._chunk.add_rows(blocks, stamps)
        self.message_count += messages
        self._last_stamp = int(stamps[ticks - 1])
        return ticks

    def add_metadata(self, name: str, values: Mapping[str, str]):
        """Append a record of names and texts, such as the settings of the run."""
        if name == 'rosbag2':
            raise ValueError("a metadata record must not be named 'rosbag2': ros2 bag would "
                             'take it for its own')
        self._check_open()
        self._file.add(Metadata(name, dict(values)))

    def add_attachment(self, name: str, data: bytes, media_type: str):
        """Append a whole file, such as the scene, under a name."""
        self._check_open()
        self._file.add(Attachment(create_time=0, log_time=self._last_stamp, name=name,
                                  media_type=media_type, data=data))

    def flush(self):
        """End the chunk in progress and hand it to the operating system."""
        self._check_open()
        if self._chunk.count:
            self._file.add_chunk(self._chunk)
            self._chunk.clear()

    def sync(self):
        """Wait until all that was flushed is on the disk."""
        self._check_open()
        self._file.sync()

    def close(self, sync: bool = False):
        """
        Finish the file with its index and close it; harmless when called again.

        sync: whether to wait until all of it is on the disk. Whatever is raised, the file is
        closed; it ends with the last whole chunk then, and what is not in it is not counted.
        """
        if self._file is None:
            return
        try:
            self.flush()
            self._file.finish()
            if sync:
                self._file.sync()
        finally:
            self.message_count -= self._chunk.count
            self._chunk.clear()
            self._file.close()
            self._file = None

    def discard(self):
        """Close the file, and delete it."""
        self._file.discard()
        self._file = None

    def __enter__(self) -> BagWriter:
        """Return the writer."""
        return self

    def __exit__(self, *_):
        """Close the file."""
        self.close()

    def _check_time(self, first_ns):
        """Raise ValueError where the file is closed, or a time is before the last one."""
        self._check_open()
        if first_ns < self._last_stamp:
            raise ValueError(f'{self.path}: a message at {first_ns} ns cannot follow one at '
                             f'{self._last_stamp} ns: times in a bag never go back')

    def _make_room(self):
        """Write the chunk in progress if it is full."""
        if self._chunk.size >= self._chunk.capacity:
            self.flush()

    def _check_open(self):
        """Raise ValueError when the file is closed."""
        if self._file is None:
            raise ValueError(f'{self.path} is closed: no more can be added to it')
