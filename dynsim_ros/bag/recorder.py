# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A thread that writes a bag, so that a simulation's tick never waits for the disk."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
import threading
import time

import numpy as np

from .pack_rows import RowPlan
from .tick_queue import TickQueue
from .writer import BagWriter
from ..messages.qos import Qos, STATE
from ..messages.tick_rows import TickRows, Wanted
from ..simulation.rows.kernel import PRESENT

# How often the thread looks for work [s]. What it finds goes to the file at once if it is worth
# a chunk of its own [bytes], and in any case before it has waited for too long [s].
_PERIOD = 0.025
_WORTH = 16 * 1024
_FLUSH_PERIOD = 0.5


class Recorder:
    """
    Writes what `put` hands over, in a thread of its own.

    Nothing raises into the caller: when the bag cannot be written, `error` says why and what
    follows counts as lost. messages: number in the bag, the chunk in progress included; lost:
    number handed over that are not and will not be in the bag; error: one line, or None; wait:
    as given at the start, may be changed.
    """

    def __init__(self, writer: BagWriter, *, capacity: int = 200_000, wait: bool = False):
        """
        Start the thread, which owns the writer from here on.

        capacity: number of messages that may be waiting. Beyond it messages are lost, or with
        `wait` (for runs that are not bound to real time) `put` waits for the disk.
        """
        self.error: str | None = None
        self._writer = writer
        self._capacity = capacity
        self.wait = wait
        # What is no row, each with the number of ticks that were put before it.
        self._queue: deque = deque()
        self._ticks: TickQueue | None = None
        self._plan: RowPlan | None = None
        # Each is counted up by one thread alone; what is between them waits.
        self._handed_over = 0
        self._taken = 0
        self._lost = 0
        self._overflow = 0
        self._writer_lock = threading.RLock()
        self._wake = threading.Event()
        self._closing = False
        self._thread = threading.Thread(target=self._run, name='bag recorder', daemon=True)
        self._thread.start()

    @property
    def messages(self) -> int:
        """Return the number of messages in the bag."""
        return self._writer.message_count

    @property
    def lost(self) -> int:
        """Return the number of messages handed over that are not in the bag."""
        return self._lost + self._overflow

    @property
    def path(self):
        """Return the path of the bag."""
        return self._writer.path

    def put(self, stamp_ns: int, messages: Sequence[tuple[int, bytes]], keep: bool = False):
        """
        Hand over the messages of one instant, as (channel id, CDR bytes), at a time in ns.

        keep: for what must not be lost even where there is no room. Returns at once; to be
        called from one thread only. After `close` messages are lost.
        """
        if self._has_no_room(len(messages), keep):
            return
        self._handed_over += len(messages)
        self._queue.append((self._ticks.put_count if self._ticks else 0, stamp_ns, messages))

    def declare_rows(self, rows: TickRows, channel_ids: Sequence[int]):
        """Let ticks of some TickRows be put; channel_ids: of their rows; once, before put_rows."""
        starts, ends = (np.array(part, np.int64) for part in (
            rows.table.start, [end for _, end in rows.spans]))
        plan = RowPlan(starts, ends, np.array(channel_ids, np.int64))
        with self._writer_lock:
            self._writer.declare_rows(plan)
        self._plan, self._ticks = plan, TickQueue(rows.size)

    def put_rows(self, rows: TickRows, stamp_ns: int, wanted: Wanted):
        """
        Hand over what was filled in last: the wanted rows of one instant.

        As `put`: they follow what was put before, and come before what is put later.
        """
        count = len(wanted.numbers)
        if ((self._handed_over - self._taken >= self._capacity or self._closing)
                and self._has_no_room(count, False)):
            return
        self._handed_over += count
        self._ticks.put(rows.view, stamp_ns)

    def put_many_rows(self, rows: TickRows, stamps: np.ndarray, wanted: Wanted):
        """Hand over likewise all instants filled in last; stamps: (instants,) int64 [ns]."""
        count = len(wanted.numbers) * len(stamps)
        if self._has_no_room(count, False):
            return
        self._handed_over += count
        self._ticks.put_many(rows.blocks, stamps)

    def add_channel(self, topic: str, type_name: str, qos: Qos = STATE) -> int:
        """Declare a topic, as `BagWriter.add_channel` does."""
        with self._writer_lock:
            return self._writer.add_channel(topic, type_name, qos)

    def add_metadata(self, name: str, values: Mapping[str, str]):
        """Append a metadata record; a failed write is kept in `error`."""
        self._attempt(self._writer.add_metadata, name, values)

    def add_attachment(self, name: str, data: bytes, media_type: str):
        """Append an attachment; a failed write is kept in `error`."""
        self._attempt(self._writer.add_attachment, name, data, media_type)

    def close(self):
        """Write what is waiting, finish the file and end the thread; harmless when repeated."""
        self._closing = True
        self._wake.set()
        self._thread.join()
        # What came while the file was being finished.
        self._overflow += self._handed_over - self._taken
        self._handed_over = self._taken

    def __enter__(self) -> Recorder:
        """Return the recorder."""
        return self

    def __exit__(self, *_):
        """Close the bag."""
        self.close()

    def _has_no_room(self, count: int, keep: bool) -> bool:
        """Tell whether so many messages cannot be taken; they are counted as lost then."""
        if self._handed_over - self._taken < self._capacity and not self._closing:
            return False
        if self._make_room() or (keep and not self._closing):
            return False
        self._overflow += count
        return True

    def _make_room(self) -> bool:
        """Wait for the thread if that is wanted; tell whether there is room now."""
        while self.wait and not self._closing and self._is_full():
            self._wake.set()
            time.sleep(0.001)
        return not (self._is_full() or self._closing)

    def _is_full(self) -> bool:
        """Tell whether as much waits as may."""
        return self._handed_over - self._taken >= self._capacity

    def _run(self):
        """Write what waits, again and again, until the recorder is closed."""
        flushed = time.monotonic()
        while not self._closing:
            self._wake.wait(_PERIOD)
            self._wake.clear()
            self._drain()
            if (self._writer.pending_bytes >= _WORTH
                    or time.monotonic() - flushed > _FLUSH_PERIOD):
                self._flush()
                flushed = time.monotonic()
        self._drain()
        self._attempt(self._writer.close)

    def _drain(self):
        """Write everything that waits, ticks and other messages in the order they came in."""
        while True:
            # Asked in this order: what is no row and was put before a tick is seen with it.
            ticks = self._ticks.put_count if self._ticks else 0
            after, stamp_ns, messages = self._queue[0] if self._queue else (ticks, 0, None)
            self._drain_ticks(min(ticks, after))
            if messages is None:
                return
            if after <= ticks:
                self._queue.popleft()
                self._attempt(self._write, stamp_ns, messages, count=len(messages))
                self._taken += len(messages)

    def _drain_ticks(self, end: int):
        """Write the ticks that were put as the first `end` ones."""
        ticks = self._ticks
        while ticks and ticks.taken_count < end:
            blocks, stamps = ticks.take(end)
            count = int((blocks[:, self._plan.start] == PRESENT).sum())
            self._attempt(self._writer.write_rows, blocks, stamps, count=count)
            ticks.release(len(blocks))
            self._taken += count

    def _write(self, stamp_ns: int, messages: Sequence[tuple[int, bytes]]):
        """Append the messages of one instant."""
        for channel_id, data in messages:
            self._writer.write(channel_id, stamp_ns, data)

    def _flush(self):
        """Bring the chunk in progress into the file."""
        if self._writer.pending:
            self._attempt(self._writer.flush)

    def _attempt(self, call, *arguments, count: int = 0):
        """Call the writer; keep the first error and count the messages that it costs."""
        with self._writer_lock:
            before = self._writer.message_count
            try:
                call(*arguments)
            except Exception as error:
                # Whatever it is, the simulation goes on and the error is shown where it counts.
                self._lost += before + count - self._writer.message_count
                if self.error is None:
                    self.error = self._describe(error)

    def _describe(self, error: Exception) -> str:
        """Return one line that says what happened to the bag."""
        if isinstance(error, OSError):
            return (f'{self.path} cannot be written: {error.strerror or error}; it holds the '
                    f'first {self.messages} messages, later ones are lost')
        return str(error) or type(error).__name__
