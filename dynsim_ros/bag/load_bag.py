# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A bag in memory: every topic as an array."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
import os
from pathlib import Path

import numpy as np

from .load_columns import columns
from .load_rows import read_rows, Rows
from .reader import BagError, open_bag
from .run_names import RUN_METADATA
from ..messages.cdr import decode
from ..messages.recorded_types import recorded_fields
from ..scene import did_you_mean

_SECOND = 1_000_000_000


class TopicError(BagError, KeyError):
    """A topic that is not there, or whose messages are no array; one line of text."""

    __str__ = ValueError.__str__


class LoadedBag(Mapping):
    """
    A mapping from topics to structured arrays, one row a message.

    Fields are named as in the message: bag['/dynsim/sphere/pose']['pose']['position']['x'] is an
    (n,) array. Wherever a topic is asked for, its name may be relative to the node, such as
    'sphere/pose', and may stand for any one topic that ends so. Times are log times in seconds:
    of our own bags the simulated time, of others since the first message.

    path: as given. channels: reader.Channel by topic, of all topics. left_out: {topic: why its
    messages are no array}; irregular: those of them that `messages` can give. problem: None, or
    one line that says what is wrong with the bag and how much could be read. metadata: records of
    names and texts, by name. attachments: (media type, content), by name. info: version, scene,
    node, epoch, … of a run of dynsim_ros, else empty. origin_ns: log time of second 0 [ns].
    """

    def __init__(self, path: str | os.PathLike, topics: str | Collection[str] | None = None,
                 start: float | None = None, end: float | None = None):
        """Read the bag, see `dynsim_ros.bag.load`."""
        self.path = Path(path)
        with open_bag(path) as bag:
            self.channels = bag.channels
            self.metadata, self.attachments = bag.metadata, bag.attachments
            self.info = bag.metadata.get(RUN_METADATA, {})
            self.origin_ns = 0 if self.info else bag.start_ns
            self._span = self._time(start, bag.start_ns), self._time(end, bag.end_ns)
            wanted = bag.matching([topics] if isinstance(topics, str) else topics or [])
            try:
                self._rows, self.left_out, self.irregular = read_rows(bag, wanted, *self._span)
            except OSError as error:
                raise BagError(f'{path}: {error.strerror or error}') from None
            self.problem, self._wanted = bag.problem, wanted

    def __getitem__(self, topic: str) -> np.ndarray:
        """Return the messages of a topic; raises TopicError for what has no array."""
        return self._of(topic).values

    def __iter__(self) -> Iterator[str]:
        """Iterate over the full names of the topics that have an array."""
        return iter(self._rows)

    def __len__(self) -> int:
        """Return how many topics have an array."""
        return len(self._rows)

    def topic(self, name: str) -> str:
        """Return the full name of a topic of the bag; raises TopicError."""
        for full in (name, f'{self.info.get("node", "")}/{name}'):
            if full in self.channels:
                return full
        ending = [topic for topic in self.channels if topic.endswith(f'/{name}')]
        if len(ending) == 1:
            return ending[0]
        if ending:
            raise TopicError(f"'{name}' is ambiguous in {self.path}: " + ', '.join(ending))
        raise TopicError(f"no topic '{name}' in {self.path}; " + did_you_mean(name, self.channels))

    def short(self, topic: str) -> str:
        """Return the name of a topic relative to the node, without a slash before it."""
        return self.topic(topic).removeprefix(f'{self.info.get("node", "")}/').lstrip('/')

    def time_ns(self, topic: str) -> np.ndarray:
        """Return (n,) int64 log times of a topic's messages [ns]."""
        return self._of(topic).time_ns

    def time(self, topic: str) -> np.ndarray:
        """Return (n,) log times of a topic's messages [s]."""
        return (self.time_ns(topic) - self.origin_ns) / _SECOND

    def columns(self, topic: str) -> dict[str, np.ndarray]:
        """Return {name: (n,) array} of a topic: 'pose.position.x', 'kinetic' of the energies."""
        return columns(self[topic])

    def to_pandas(self, topic: str):
        """Return a pandas.DataFrame of `columns` with `time` as its index; needs pandas."""
        try:
            import pandas
        except ImportError:
            raise ImportError('to_pandas needs pandas: pip install pandas') from None
        index = pandas.Index(self.time(topic), name='time')
        return pandas.DataFrame(
            {name: column.astype(column.dtype.newbyteorder('='))
             for name, column in self.columns(topic).items()}, index)

    def messages(self, topic: str) -> Iterator[tuple[int, dict]]:
        """
        Yield (log time [ns], message as nested dict) of a topic, whatever its messages hold.

        For messages without a fixed layout; a thousandth as fast as the arrays. Reads the file.
        """
        yield from ((time_ns, message) for _, time_ns, message
                    in self._decoded([self.topic(topic)]))

    def _decoded(self, topics: Collection[str]) -> Iterator[tuple[str, int, dict]]:
        """Yield (topic, log time, message) of some topics, in order of time."""
        fields_of = {topic: recorded_fields(self.channels[topic].type_name,
                                            self.channels[topic].definition) for topic in topics}
        with open_bag(self.path) as bag:
            for topic, time_ns, data in bag.messages(topics, *self._span):
                yield topic, time_ns, decode(self.channels[topic].type_name, data,
                                             fields_of[topic])

    def _of(self, name: str) -> Rows:
        topic = self.topic(name)
        if topic not in self._rows:
            reason = self.left_out.get(topic) or (
                'there are none' if topic in self._wanted else 'they were not asked for')
            raise TopicError(f'{topic} in {self.path} is no array of messages: {reason}')
        return self._rows[topic]

    def _time(self, seconds: float | None, otherwise_ns: int) -> int:
        return otherwise_ns if seconds is None else self.origin_ns + round(seconds * _SECOND)
