# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What waits to be written: ticks and everything else, in the order it was handed over."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

import numpy as np

from .tick_queue import TickQueue


class Backlog:
    """
    A queue of ticks and of other things; one thread hands over, another one works it off.

    Neither waits for the other.
    """

    def __init__(self):
        # What is no tick: ticks before it, messages in it, what to call, and with what.
        self._others: deque[tuple[int, int, Callable, tuple]] = deque()
        self._ticks: TickQueue | None = None
        # Each is counted up by one thread alone.
        self._handed_over = 0
        self._taken = 0

    @property
    def waiting(self) -> int:
        """Return the number of messages that wait."""
        return self._handed_over - self._taken

    def declare_rows(self, size: int):
        """Let ticks be added, as blocks of so many bytes; once."""
        self._ticks = TickQueue(size)

    def add_rows(self, block: memoryview, stamp_ns: int, messages: int):
        """Append the block of a tick that holds so many messages."""
        self._handed_over += messages
        self._ticks.put(block, stamp_ns)

    def add_many_rows(self, blocks: np.ndarray, stamps: np.ndarray, messages: int):
        """Append blocks: (n, size), of times (n,) [ns], with so many messages in all."""
        self._handed_over += messages
        self._ticks.put_many(blocks, stamps)

    def add(self, messages: int, call: Callable, *arguments):
        """Append something that is no tick: call(*arguments) writes it, so many messages."""
        self._handed_over += messages
        self._others.append((self._ticks.put_count if self._ticks else 0, messages, call,
                             arguments))

    def work_off(self, write_rows: Callable[[np.ndarray, np.ndarray], tuple[int, int]]):
        """
        Write everything that waits.

        write_rows: takes blocks and stamps, writes the first ones and returns of how many ticks
        and messages. Whatever is raised, what was not written by then goes on waiting.
        """
        while True:
            # Asked in this order: what is no tick and was added before one is seen with it.
            ticks = self._ticks.put_count if self._ticks else 0
            after, messages, call, arguments = self._others[0] if self._others else (
                ticks, 0, None, ())
            self._work_off_ticks(min(ticks, after), write_rows)
            if call is None:
                return
            if after <= ticks:
                call(*arguments)
                self._others.popleft()
                self._taken += messages

    def _work_off_ticks(self, end, write_rows):
        """Write the ticks that were added as the first `end` ones."""
        ticks = self._ticks
        while ticks and ticks.taken_count < end:
            count, messages = write_rows(*ticks.take(end))
            ticks.release(count)
            self._taken += messages

    def drop(self) -> int:
        """Forget all that waits; return how many messages that was."""
        dropped = self.waiting
        self._taken = self._handed_over
        return dropped
