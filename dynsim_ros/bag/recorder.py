# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recording without waiting: a simulation's tick hands over, another thread writes the bag."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
import time

import numpy as np

from .backlog import Backlog
from .bag_thread import BagThread
from .gap import Gap
from .pack_rows import RowPlan
from .writer import BagWriter
from ..messages.qos import Qos, STATE
from ..messages.tick_rows import TickRows, Wanted

_TOO_SLOW = 'the disk is too slow'


class Recorder:
    """
    Writes what `put` hands over, in a thread of its own.

    Nothing raises into the caller. Where the bag cannot be written, what is handed over waits, as
    much as `capacity` allows; what finds no room is lost and counted, and the bag tells of it, see
    Gap. capacity: as given at the start; wait: likewise, may be changed; news: deque of (whether
    it is an error, one line), to be taken out and shown.
    """

    def __init__(self, writer: BagWriter, *, capacity: int = 200_000, wait: bool = False,
                 sync_period: float = 0.0):
        """
        Start the thread, which owns the writer from here on.

        capacity: number of messages that may be waiting. Beyond it messages are lost, or with
        `wait` (for runs that are not bound to real time) `put` waits for the disk, unless that
        fails. sync_period: how often the bag is brought to the disk [s]; 0: when the operating
        system chooses to.
        """
        self.capacity = capacity
        self.wait = wait
        self._backlog = Backlog()
        self._thread = BagThread(writer, self._backlog, sync_period)
        self.news = self._thread.news
        # Counted by the putting thread.
        self._overflow = 0
        self._gap: Gap | None = None

    @property
    def messages(self) -> int:
        """Return the number of messages in the bag, what is on its way to the file included."""
        return self._thread.messages

    @property
    def waiting(self) -> int:
        """Return the number of messages handed over that are not in the bag yet."""
        return self._backlog.waiting

    @property
    def lost(self) -> int:
        """Return the number of messages handed over that are not and will not be in the bag."""
        return self._overflow + self._thread.lost

    @property
    def error(self) -> str | None:
        """Return what went wrong last, in one line, or None."""
        return self._thread.error or (_TOO_SLOW if self._overflow else None)

    @property
    def is_failing(self) -> bool:
        """Tell whether the bag cannot be written now, or messages are being lost."""
        return self._thread.is_failing or self._gap is not None

    @property
    def paths(self):
        """Return the paths of the bag's files so far, see `go_on_in`."""
        return self._thread.paths

    @property
    def unfinished(self):
        """Return the paths of those that could not be finished, and have to be recovered."""
        return self._thread.unfinished

    @property
    def path(self):
        """Return the path of the last of them."""
        return self._thread.paths[-1]

    @property
    def size(self) -> int:
        """Return how many bytes that file will have, about, if it is finished now."""
        return self._thread.writer.size

    def put(self, stamp_ns: int, messages: Sequence[tuple[int, bytes]], keep: bool = False):
        """
        Hand over the messages of one instant, as (channel id, CDR bytes), at a time in ns.

        keep: for what must not be lost even where there is no room, up to twice as much. Returns
        at once; to be called from one thread only. After `close` messages are lost.
        """
        count = len(messages)
        if self._has_room() or (keep and self._has_room_to_keep()):
            self._backlog.add(count, self._thread.write, stamp_ns, messages)
        else:
            self._lose(stamp_ns, count)

    def declare_rows(self, rows: TickRows, channel_ids: Sequence[int]):
        """Let ticks of some TickRows be put; channel_ids: of their rows; once, before put_rows."""
        starts, ends = (np.array(part, np.int64) for part in (
            rows.table.start, [end for _, end in rows.spans]))
        self._thread.declare_rows(RowPlan(starts, ends, np.array(channel_ids, np.int64)))
        self._backlog.declare_rows(rows.size)

    def put_rows(self, rows: TickRows, stamp_ns: int, wanted: Wanted):
        """
        Hand over what was filled in last: the wanted rows of one instant.

        As `put`: they follow what was put before, and come before what is put later.
        """
        count = len(wanted.numbers)
        if self._has_room():
            self._backlog.add_rows(rows.view, stamp_ns, count)
        else:
            self._lose(stamp_ns, count)

    def put_many_rows(self, rows: TickRows, stamps: np.ndarray, wanted: Wanted):
        """Hand over likewise the first instants filled in last; stamps: (instants,) int64 [ns]."""
        count = len(wanted.numbers)
        if self._has_room():
            self._backlog.add_many_rows(rows.blocks[:len(stamps)], stamps, count * len(stamps))
            return
        for stamp_ns in stamps.tolist():
            self._lose(stamp_ns, count)

    def hurry(self):
        """Let what was handed over be written now, if that is not done often already."""
        self._thread.hurry()

    def go_on_in(self, make: Callable[[], BagWriter]):
        """
        Let what is put from here on go to another file, and finish this one.

        make: returns the writer of that, with the same channels; called in the writing thread,
        again and again if it raises OSError.
        """
        self._backlog.add(0, self._thread.change_over, make)

    def add_channel(self, topic: str, type_name: str, qos: Qos = STATE) -> int:
        """Declare a topic, as `BagWriter.add_channel` does; waits for the disk."""
        with self._thread.lock:
            return self._thread.writer.add_channel(topic, type_name, qos)

    def add_metadata(self, name: str, values: Mapping[str, str]):
        """Hand over a metadata record, see `BagWriter.add_metadata`."""
        self._backlog.add(0, lambda: self._thread.writer.add_metadata(name, values))

    def add_attachment(self, name: str, data: bytes, media_type: str):
        """Hand over an attachment, see `BagWriter.add_attachment`."""
        self._backlog.add(0, lambda: self._thread.writer.add_attachment(name, data, media_type))

    def close(self):
        """Write what is waiting, finish the file and end the thread; harmless when repeated."""
        self._end_gap()
        self._thread.end()
        # What came while the file was being finished.
        self._overflow += self._backlog.drop()

    def __enter__(self) -> Recorder:
        """Return the recorder."""
        return self

    def __exit__(self, *_):
        """Close the bag."""
        self.close()

    def _has_room(self) -> bool:
        """Tell whether messages can be taken."""
        if (self._gap is None and self._backlog.waiting < self.capacity
                and not self._thread.is_closing):
            return True
        return self._makes_room()

    def _makes_room(self) -> bool:
        """Wait for the disk where that is wanted; tell whether there is room now."""
        backlog, thread = self._backlog, self._thread
        while (self.wait and backlog.waiting >= self.capacity and self._gap is None
               and not (thread.is_failing or thread.is_closing)):
            thread.wake.set()
            time.sleep(0.001)
        # Where something was lost, more is until half is written: a few long gaps, not many.
        room = self.capacity if self._gap is None else max(self.capacity // 2, 1)
        if thread.is_closing or backlog.waiting >= room:
            return False
        self._end_gap()
        return True

    def _has_room_to_keep(self) -> bool:
        return self._backlog.waiting < 2 * self.capacity and not self._thread.is_closing

    def _lose(self, stamp_ns: int, count: int):
        """Count messages that found no room."""
        if self._gap is None and not self._thread.is_closing:
            reason = self._thread.error if self._thread.is_failing else _TOO_SLOW
            self._gap = Gap(reason, stamp_ns)
            self.news.append((True, f'messages are lost from {stamp_ns * 1e-9:.3f} s on, until '
                              f'half of the {self.capacity} that wait are written: {reason}'))
        if self._gap is not None:
            self._gap.add(stamp_ns, count)
        self._overflow += count

    def _end_gap(self):
        """Have the bag tell of what was lost by now."""
        if self._gap is not None:
            self._backlog.add(0, self._thread.write_gap, self._gap)
            self._gap = None
