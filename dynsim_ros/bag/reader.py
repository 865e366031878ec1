# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bags read back: ours, rosbag2's and any other MCAP file, whole or cut off."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import cached_property
from heapq import merge
from io import BytesIO
import os
from pathlib import Path

from mcap.data_stream import ReadDataStream
from mcap.records import Attachment

from .index import Block
from .records import DamagedChunk, messages_in
from .sources import BagError, open_sources, Source
from ..messages.qos import offered, Qos

__all__ = ['Bag', 'BagError', 'Channel', 'open_bag']


@dataclass
class Channel:
    """
    A topic of a bag.

    type_name: 'package/msg/Name'; encoding: 'cdr' for ROS messages; definition: the text of
    the message definition, '' where the bag has none; type_hash: 'RIHS01_…' or ''; qos: what the
    publisher offered, None where the bag does not tell; count: number of messages.
    """

    topic: str
    type_name: str
    encoding: str
    definition: str
    type_hash: str
    qos: Qos | None
    count: int = 0


class Bag:
    """
    A bag that is open for reading; a context manager that closes it.

    path: as given. channels: by topic, in the order of the file. start_ns, end_ns: first and
    last log time in ns, both 0 where there is no message. count: number of messages.
    metadata: records of names and texts, by record name. problem: None, or one line that says
    what is wrong and how much could be read; may be set while messages are read.
    """

    def __init__(self, path: str | os.PathLike):
        """Open the bag; raises BagError, in one line, for what is not a bag."""
        self.path = Path(path)
        self._sources = open_sources(self.path)
        self.channels: dict[str, Channel] = {}
        self.metadata: dict[str, dict[str, str]] = {}
        self._problems: dict[str, None] = {}
        self._topics: list[dict[int, str]] = []
        for source in self._sources:
            if source.index.problem:
                self._report(source, source.index.problem)
            for name, values in source.index.metadata.items():
                self.metadata.setdefault(name, {}).update(values)
            self._topics.append(self._add_channels(source))
        blocks = [block for source in self._sources for block in source.index.blocks
                  if block.start_ns <= block.end_ns]
        self.count = sum(channel.count for channel in self.channels.values())
        self.start_ns = min((block.start_ns for block in blocks), default=0) if self.count else 0
        self.end_ns = max((block.end_ns for block in blocks), default=0) if self.count else 0

    @property
    def complete(self) -> bool:
        """Tell whether nothing was found wrong with the bag so far."""
        return not self._problems

    @property
    def problem(self) -> str | None:
        """Return one line that says what is wrong with the bag, or None."""
        return '; '.join(self._problems) or None

    @cached_property
    def attachments(self) -> dict[str, tuple[str, bytes]]:
        """Return the attached files by name, each as (media type, content)."""
        found = {}
        for source in self._sources:
            for record in source.index.attachments:
                attached = Attachment.read(ReadDataStream(BytesIO(record.read(source.stream))))
                found[attached.name] = (attached.media_type, attached.data)
        return found

    def messages(self, topics: Collection[str] | None = None, start_ns: int | None = None,
                 end_ns: int | None = None) -> Iterator[tuple[str, int, bytes]]:
        """
        Yield (topic, log time in ns, CDR bytes) in the order of time.

        Messages of one time keep the order of the file. topics: which ones, None for all;
        start_ns, end_ns: first and last log time wanted, both included.
        """
        wanted = set(self.channels if topics is None else topics)
        low = self.start_ns if start_ns is None else start_ns
        high = self.end_ns if end_ns is None else end_ns
        return merge(*(self._of(source, {key: topic for key, topic in by_id.items()
                                         if topic in wanted}, low, high)
                       for source, by_id in zip(self._sources, self._topics, strict=True)),
                     key=lambda message: message[1])

    def matching(self, patterns: Collection[str]) -> list[str]:
        """
        Return the topics that match names or patterns with * and ?, each once; all for none.

        A name may lack its beginning: 'sphere/pose' matches '/dynsim/sphere/pose'. Raises BagError
        for one that matches nothing.
        """
        found = []
        for pattern in patterns:
            matches = [topic for topic in self.channels if fnmatchcase(topic, pattern)] or [
                topic for topic in self.channels if fnmatchcase(topic, f'*/{pattern}')]
            if not matches:
                raise BagError(f"no topic '{pattern}' in {self.path}: it has "
                               + ', '.join(sorted(self.channels)))
            found += matches
        return list(dict.fromkeys(found if patterns else self.channels))

    def files(self) -> Iterator[tuple[Source, dict[int, str]]]:
        """Yield the files in order, each with the topics of its channels by id."""
        return zip(self._sources, self._topics, strict=True)

    def report_damage(self, source: Source, block: Block, error: DamagedChunk):
        """Let `problem` tell that not all of a block could be read."""
        self._report(source, f'the chunk at byte {block.start} is damaged ({error}): not all '
                     'messages could be read')

    def close(self):
        """Close the files."""
        for source in self._sources:
            source.stream.close()

    def __enter__(self) -> Bag:
        """Return the bag."""
        return self

    def __exit__(self, *_):
        """Close the files."""
        self.close()

    def _add_channels(self, source: Source) -> dict[int, str]:
        """Add a file's channels to `channels`; return the topic of each channel id."""
        topics = {}
        for key, record in source.index.channels.items():
            schema = source.index.schemas.get(record.schema_id)
            channel = Channel(
                record.topic, _full_name(schema.name) if schema else '', record.message_encoding,
                schema.data.decode(errors='replace') if schema else '',
                record.metadata.get('topic_type_hash', ''),
                offered(record.metadata.get('offered_qos_profiles', '')))
            known = self.channels.setdefault(record.topic, channel)
            if (known.type_name, known.encoding) != (channel.type_name, channel.encoding):
                self._report(source, f'{record.topic} is {known.type_name} and also '
                             f'{channel.type_name}: the latter is left out')
                continue
            known.count += source.index.counts[key]
            topics[key] = record.topic
        return topics

    def _of(self, source: Source, topics: dict[int, str], low: int, high: int
            ) -> Iterator[tuple[str, int, bytes]]:
        """Yield one file's messages of some channels between two times, in order of time."""
        for log_ns, _, _, channel_id, data in self._sorted(source, topics, low, high):
            yield topics[channel_id], log_ns, source.unpack(data) if source.unpack else data

    def _sorted(self, source: Source, topics: Collection[int], low: int, high: int
                ) -> Iterator[tuple]:
        """
        Yield (log time, position of the block, number in it, channel id, data), sorted.

        Blocks may overlap: what is read ahead leaves as soon as no later block can precede it.
        """
        ahead: list[tuple] = []
        blocks = [block for block in source.index.blocks
                  if block.start_ns <= high and block.end_ns >= low]
        for block in sorted(blocks):
            ready = bisect_left(ahead, (block.start_ns,))
            yield from ahead[:ready]
            del ahead[:ready]
            source.stream.seek(block.start)
            content = source.stream.read(block.end - block.start)
            try:
                for number, message in enumerate(messages_in(content)):
                    if message.channel_id in topics and low <= message.log_ns <= high:
                        ahead.append((message.log_ns, block.start, number, message.channel_id,
                                      message.data))
            except DamagedChunk as error:
                self.report_damage(source, block, error)
            ahead.sort()
        yield from ahead

    def _report(self, source: Source, problem: str):
        """Keep one line about a problem, each once."""
        name = f'{source.path.name}: ' if len(self._sources) > 1 else ''
        self._problems[name + problem] = None


def open_bag(path: str | os.PathLike) -> Bag:
    """
    Open an MCAP file, or the folder of a rosbag2 recording, for reading.

    A file that is cut off or damaged opens with what can be read of it, see `Bag.problem`.
    Raises BagError, in one line, for what is missing, empty or not a bag.
    """
    return Bag(path)


def _full_name(type_name: str) -> str:
    """Return a type name in its long form: some writers leave the 'msg' out."""
    package, _, name = type_name.partition('/')
    return type_name if '/' in name or not name else f'{package}/msg/{name}'
