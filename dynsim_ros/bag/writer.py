# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bags written as MCAP files that ros2 bag, Foxglove, mcap and rosbags open."""

from __future__ import annotations

from collections.abc import Mapping
import os
from pathlib import Path

from mcap.writer import CompressionType, Writer

from .output import Output
from ..messages.definitions import definition
from ..messages.qos import Qos, STATE

COMPRESSIONS = {
    'zstd': CompressionType.ZSTD, 'lz4': CompressionType.LZ4, 'none': CompressionType.NONE}

# Of a program that is killed at most the chunk in progress is lost.
CHUNK_SIZE = 64 * 1024

# Record header and fixed fields of a message in a chunk.
_MESSAGE_OVERHEAD = 31


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
        self._chunk_size = chunk_size
        self._chunk_bytes = 0
        self._chunk_messages = 0
        self._last_stamp = 0
        self._schemas: dict[str, int] = {}
        self._failed = False
        self._output = Output(self.path)
        # Chunks are ended here by flush(), which is what tells how much is safe in the file.
        self._writer = Writer(
            self._output, chunk_size=2 ** 62, compression=COMPRESSIONS[compression])
        self._guarded(self._writer.start, profile='ros2', library=library)

    @property
    def pending(self) -> int:
        """Return the number of messages in the chunk in progress, not yet in the file."""
        return self._chunk_messages

    def add_channel(self, topic: str, type_name: str, qos: Qos = STATE) -> int:
        """Declare a topic of an installed message type; return the id to write to it with."""
        described = definition(type_name)
        if type_name not in self._schemas:
            self._schemas[type_name] = self._writer.register_schema(
                type_name, 'ros2msg', described.text.encode())
        metadata = {'offered_qos_profiles': qos.offered_qos_profiles()}
        if described.type_hash:
            metadata['topic_type_hash'] = described.type_hash
        return self._writer.register_channel(topic, 'cdr', self._schemas[type_name], metadata)

    def write(self, channel_id: int, stamp_ns: int, data: bytes):
        """Append a message at a time in ns; raises ValueError for a time before the last one."""
        if stamp_ns < self._last_stamp:
            raise ValueError(f'{self.path}: a message at {stamp_ns} ns cannot follow one at '
                             f'{self._last_stamp} ns: times in a bag never go back')
        self._check_usable()
        self._last_stamp = stamp_ns
        self._writer.add_message(channel_id, stamp_ns, data, stamp_ns)
        self.message_count += 1
        self._chunk_messages += 1
        self._chunk_bytes += len(data) + _MESSAGE_OVERHEAD
        if self._chunk_bytes > self._chunk_size:
            self.flush()

    def add_metadata(self, name: str, values: Mapping[str, str]):
        """Append a record of names and texts, such as the settings of the run."""
        if name == 'rosbag2':
            raise ValueError("a metadata record must not be named 'rosbag2': ros2 bag would "
                             'take it for its own')
        self._check_usable()
        self._guarded(self._writer.add_metadata, name, dict(values))

    def add_attachment(self, name: str, data: bytes, media_type: str):
        """Append a whole file, such as the scene, under a name."""
        self._check_usable()
        self._guarded(self._writer.add_attachment, 0, self._last_stamp, name, media_type, data)

    def flush(self):
        """End the chunk in progress and hand it to the operating system."""
        self._check_usable()
        self._guarded(self._writer.flush)
        self._chunk_bytes = self._chunk_messages = 0

    def close(self):
        """Finish the file with its index and close it; harmless when called again."""
        if self._output is None:
            return
        try:
            if not self._failed:
                self.flush()
                self._guarded(self._writer.finish)
        finally:
            self._output.close()
            self._output = None

    def __enter__(self) -> BagWriter:
        """Return the writer."""
        return self

    def __exit__(self, *_):
        """Close the file."""
        self.close()

    def _guarded(self, call, *arguments, **named):
        """Call into the MCAP writer; after a failed write its state is not to be used again."""
        try:
            call(*arguments, **named)
        except OSError:
            self._failed = True
            self.message_count -= self._chunk_messages
            self._chunk_messages = 0
            raise

    def _check_usable(self):
        """Raise ValueError when the file is closed or a write has failed."""
        if self._output is None or self._failed:
            reason = 'is closed' if self._output is None else 'could not be written'
            raise ValueError(f'{self.path} {reason}: no more can be added to it')
