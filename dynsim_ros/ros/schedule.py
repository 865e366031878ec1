# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which messages are due at which ticks, and which of them somebody wants."""

from collections import Counter
from collections.abc import Callable
from typing import NamedTuple

from .sending import Sending
from ..messages.tick_rows import TickRows, Wanted

# More ticks than any run has.
_FAR = 2 ** 62


class Due(NamedTuple):
    """
    What to build at a tick.

    rows: Wanted; is_heard: whether somebody listens to any of them; send: publishes those that are
    heard, see Sending; others: [(channel, publisher)] of what is no row, the publisher None where
    nobody listens.
    """

    rows: Wanted
    is_heard: bool
    send: Callable
    others: list


class Stretch(NamedTuple):
    """
    Ticks in a row whose messages are the same rows: a Due of each, and how many they are.

    others: what is due besides at the last of them, as in Due.
    """

    due: Due
    count: int
    others: list

    def first(self, count):
        """Return the Stretch of its first ticks, at most so many."""
        return self if count >= self.count else Stretch(self.due, count, [])


class Schedule:
    """
    What to build at which ticks, worked out anew only when something about it changes.

    every: after how many ticks each of channels and publishers has a message, 0 for never; heard:
    whether anybody listens; recording: whether all is wanted; made_for: what it was worked out
    for; rows: TickRows of the channels; sending: how they are published. wanted: [(channel,
    publisher, every so many ticks)] of what is built, the publisher None where nobody listens.
    """

    def __init__(self, channels, publishers, every, heard, recording, made_for, rows: TickRows,
                 sending: Sending):
        self.made_for = made_for
        self.wanted = [(channel, publisher if listens else None, ticks)
                       for channel, publisher, listens, ticks
                       in zip(channels, publishers, heard, every)
                       if ticks and (listens or recording)]
        self._intervals = sorted({ticks for _, _, ticks in self.wanted})
        self._due = list(Counter(filter(None, every)).items())
        self._longer = [ticks for ticks in self._intervals if ticks > 1]
        self._rows, self._sending = rows, sending
        self._built = {}

    def ticks_to_wanted(self, tick):
        """Return how many ticks it is to the next one with a wanted message; None: for ever."""
        if not self._intervals:
            return None
        if self._intervals[0] == 1:
            return 1
        return min(ticks - tick % ticks for ticks in self._intervals)

    def due(self, tick):
        """Return the Due of a tick."""
        # The same at all ticks at which the same intervals end.
        ends = tuple([tick % ticks == 0 for ticks in self._longer])
        due = self._built.get(ends)
        if due is None:
            due = self._built[ends] = self._work_out(tick)
        return due

    def stretch(self, tick, most):
        """Return the Stretch of at most so many ticks that follow one, None if it has no tick."""
        if self._intervals[:1] != [1] or most < 1:
            return None
        due = self.due(tick + 1)
        # What is no row comes at longer intervals than rows do, if these come at each tick.
        alike = min((ticks - tick % ticks for ticks in self._longer), default=_FAR)
        if alike > most:
            return Stretch(due, most, [])
        last = self.due(tick + alike)
        # Where rows have longer intervals as well, another one may be due then.
        if last.rows is due.rows:
            return Stretch(due, alike, last.others)
        return Stretch(due, alike - 1, []) if alike > 1 else None

    def _work_out(self, tick):
        due = [(channel, publisher) for channel, publisher, ticks in self.wanted
               if tick % ticks == 0]
        rows = self._rows.of([channel for channel, _ in due if channel.row is not None])
        publishers = [publisher for channel, publisher in due if channel.row is not None]
        heard = [(i, publisher) for i, publisher in zip(rows.numbers, publishers)
                 if publisher is not None]
        others = [(channel, publisher) for channel, publisher in due if channel.row is None]
        return Due(rows, bool(heard), self._sending.of(heard), others)

    def due_between(self, first, last):
        """Return how many messages are due at the ticks first + 1 to last, wanted or not."""
        return sum(count * (last // ticks - first // ticks) for ticks, count in self._due)
