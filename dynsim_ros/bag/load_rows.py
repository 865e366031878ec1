# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The messages of a bag as arrays by topic: whole chunks at a time, no message by itself."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import NamedTuple

from mcap.opcode import Opcode
import numpy as np

from .index import Block
from .load_column import Column, Rows, SLACK
from .load_kernel import Found, prepare_finding, room_for
from .reader import Bag
from .records import DamagedChunk, HEAD, open_chunk
from .sources import Source

# Chunks are taken together until they have so many bytes.
_BATCH = 4 * 1024 * 1024


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
    chunks: list[tuple[Block, bytes]] = []
    size = 0
    for block in sorted(source.index.blocks, key=lambda block: block.start):
        if block.start_ns > high or block.end_ns < low:
            continue
        try:
            chunks.append((block, _records(source, block)))
        except DamagedChunk as error:
            bag.report_damage(source, block, error)
            continue
        size += len(chunks[-1][1])
        if size >= _BATCH:
            yield _messages(bag, source, chunks)
            chunks, size = [], 0
    yield _messages(bag, source, chunks)


def _records(source: Source, block: Block) -> bytes:
    """Return the records of a stretch of a file, out of their chunk."""
    source.stream.seek(block.start)
    content = source.stream.read(block.end - block.start)
    is_chunk = content[:1] == bytes([Opcode.CHUNK])
    return open_chunk(content[HEAD.size:]) if is_chunk else content


def _messages(bag: Bag, source: Source, chunks: list[tuple[Block, bytes]]
              ) -> tuple[np.ndarray, Found]:
    """Return the records of some blocks as one array, and the messages among them."""
    find = prepare_finding()
    data = bytearray().join([*(records for _, records in chunks), bytes(SLACK)])
    data = np.frombuffer(data, np.uint8)
    found, count, start = room_for(len(data)), 0, 0
    for block, records in chunks:
        count = find(data, start, start + len(records), found, count)
        if count < 0:
            bag.report_damage(source, block, DamagedChunk('its records do not fit'))
            count = -count - 1
        start += len(records)
    return data, Found(*(part[:count] for part in found))
