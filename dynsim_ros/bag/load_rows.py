# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The messages of a bag as arrays by topic: whole chunks at a time, no message by itself."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
import itertools
import operator
import os
from typing import NamedTuple

from mcap.opcode import Opcode
import numpy as np

from .index import Block
from .load_column import Column, Rows, SLACK
from .load_messages import Found, indexed, walked
from .reader import Bag
from .records import DamagedChunk, HEAD, open_chunk
from .sources import Source

# Chunks are taken together until they have so many bytes.
_BATCH = 4 * 1024 * 1024
# Several cores decompress at once: that needs no Python, nor does it hold it up.
_WORKERS = min(os.cpu_count() or 1, 8)


class Chunk(NamedTuple):
    """A stretch of a file: where it lies, the records in it, and its message index records."""

    block: Block
    records: bytes
    index: bytes


class LoadedRows(NamedTuple):
    """
    The messages of a bag.

    rows: by topic. left_out: {topic whose messages are no rows: why that is}. irregular: those of
    them that are merely not laid out alike.
    """

    rows: dict[str, Rows]
    left_out: dict[str, str]
    irregular: list[str]


def read_rows(bag: Bag, topics: Collection[str], low: int, high: int) -> LoadedRows:
    """Return all messages of some topics between two log times [ns], both included."""
    columns = {topic: Column(bag.channels[topic]) for topic in topics}
    for source, topic_of in bag.files():
        number_of = np.full(2 ** 16, -1, np.int16)
        for number, topic in enumerate(columns):
            number_of[[key for key, name in topic_of.items() if name == topic]] = number
        for data, found in _batches(bag, source, low, high):
            numbers = number_of[found.channel]
            numbers[(found.log_ns < low) | (found.log_ns > high)] = -1
            for number, column in enumerate(columns.values()):
                chosen = np.flatnonzero(numbers == number)
                if len(chosen):
                    column.add(source, data, *(part[chosen] for part in found[1:]))
    rows = {topic: column.rows() for topic, column in columns.items()}
    return LoadedRows(
        {topic: found for topic, found in rows.items() if found},
        {topic: column.left_out for topic, column in columns.items() if column.left_out},
        [topic for topic, column in columns.items() if column.irregular])


def _batches(bag: Bag, source: Source, low: int, high: int
             ) -> Iterator[tuple[np.ndarray, Found]]:
    """Yield records as (n,) uint8 and the messages among them, in the order of the file."""
    batch: list[Chunk] = []
    size = 0
    for block, opening in _openings(source, low, high):
        try:
            batch.append(opening.result())
        except DamagedChunk as error:
            bag.report_damage(source, block, error)
            continue
        size += len(batch[-1].records)
        if size >= _BATCH:
            yield _messages(bag, source, batch)
            batch, size = [], 0
    if batch:
        yield _messages(bag, source, batch)


def _openings(source: Source, low: int, high: int) -> Iterator[tuple[Block, Future[Chunk]]]:
    """Yield the blocks with messages of some times and what opens them, a few ahead."""
    ahead: deque[tuple[Block, Future[Chunk]]] = deque()
    with ThreadPoolExecutor(_WORKERS) as pool:
        for block in sorted(source.index.blocks, key=lambda block: block.start):
            if block.start_ns > high or block.end_ns < low:
                continue
            source.stream.seek(block.start)
            content = source.stream.read(block.end - block.start)
            index = source.stream.read(block.index_size)
            ahead.append((block, pool.submit(_opened, block, content, index)))
            if len(ahead) > 4 * _WORKERS:
                yield ahead.popleft()
        yield from ahead


def _opened(block: Block, content: bytes, index: bytes) -> Chunk:
    """Return a stretch of a file, out of its chunk; raises DamagedChunk."""
    is_chunk = content[:1] == bytes([Opcode.CHUNK])
    return Chunk(block, open_chunk(content[HEAD.size:]) if is_chunk else content, index)


def _messages(bag: Bag, source: Source, chunks: list[Chunk]) -> tuple[np.ndarray, Found]:
    """Return the records of some chunks as one array, and the messages among them."""
    records = [chunk.records for chunk in chunks]
    data = np.frombuffer(bytearray().join([*records, bytes(SLACK)]), np.uint8)
    bases = itertools.accumulate(map(len, records), initial=0)
    found = indexed(data[:-SLACK], [(base, chunk.index) for base, chunk in zip(bases, chunks)])
    if found is None:
        found, fit = walked(records)
        for chunk in itertools.compress(chunks, map(operator.not_, fit)):
            bag.report_damage(source, chunk.block, DamagedChunk('its records do not fit'))
    return data, found
