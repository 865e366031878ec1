# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Ticks on their way from the thread that ticks to the one that writes."""

from __future__ import annotations

from collections import deque

import numpy as np

# Memory that is handed from one thread to the other at once, about [bytes]; and how much of it is
# kept for later.
_PAGE = 128 * 1024
_SPARE_PAGES = 8


class _Page:
    """Room for some ticks: blocks (ticks, bytes) uint8 and stamps (ticks,) [ns]."""

    def __init__(self, ticks, size):
        self.blocks = np.empty((ticks, size), np.uint8)
        self.stamps = np.empty(ticks, np.int64)
        # Memory is there from now on: the thread that puts does not wait for it.
        self.blocks.fill(0)
        self.stamps.fill(0)
        # Written to through these, in a third of the time.
        self.data, self.times = memoryview(self.blocks.reshape(-1)), memoryview(self.stamps)


class TickQueue:
    """
    A queue of blocks; one thread puts, another one takes, neither waits for the other.

    size: bytes of a block. put_count, taken_count: ticks so far. Its memory is used again and
    again: it grows, and shrinks, with what waits alone.
    """

    def __init__(self, size: int):
        self.put_count = self.taken_count = 0
        self._size = size
        self._page_ticks = max(_PAGE // max(size, 1), 16)
        self._pages: deque[_Page] = deque()
        self._spare: deque[_Page] = deque([self._new_page(), self._new_page()])
        self._page: _Page | None = None

    def put(self, block: memoryview, stamp_ns: int):
        """Append one block, (size,) bytes."""
        slot = self.put_count % self._page_ticks
        if slot == 0:
            self._turn()
        page, start = self._page, slot * self._size
        page.data[start:start + self._size] = block
        page.times[slot] = stamp_ns
        # From here on the other thread may take it.
        self.put_count += 1

    def put_many(self, blocks: np.ndarray, stamps: np.ndarray):
        """Append blocks: (n, size), of times (n,) [ns]."""
        while len(blocks):
            slot = self.put_count % self._page_ticks
            if slot == 0:
                self._turn()
            count = min(len(blocks), self._page_ticks - slot)
            self._page.blocks[slot:slot + count] = blocks[:count]
            self._page.stamps[slot:slot + count] = stamps[:count]
            self.put_count += count
            blocks, stamps = blocks[count:], stamps[count:]

    def take(self, end: int) -> tuple[np.ndarray, np.ndarray]:
        """
        Return blocks and stamps of ticks taken_count and on, up to `end` or the end of a page.

        end: not above put_count. They are to be released when they are no longer needed.
        """
        slot = self.taken_count % self._page_ticks
        count = min(end - self.taken_count, self._page_ticks - slot)
        page = self._pages[0]
        return page.blocks[slot:slot + count], page.stamps[slot:slot + count]

    def release(self, count: int):
        """Give the memory of the first so many ticks, all of one page, back."""
        self.taken_count += count
        if self.taken_count % self._page_ticks == 0:
            page = self._pages.popleft()
            if len(self._spare) < _SPARE_PAGES:
                self._spare.append(page)

    def _turn(self):
        """Go on with another page."""
        self._page = self._spare.popleft() if self._spare else self._new_page()
        self._pages.append(self._page)

    def _new_page(self):
        return _Page(self._page_ticks, self._size)
