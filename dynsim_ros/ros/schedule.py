# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which messages are due at which ticks, and which of them somebody wants."""

from collections import Counter


class Schedule:
    """
    What to build at which ticks, worked out anew only when something about it changes.

    every: after how many ticks each of channels and publishers has a message, 0 for never; heard:
    whether anybody listens; recording: whether all is wanted; made_for: what it was worked out
    for. wanted: [(channel, publisher, every so many ticks)] of what is built, the publisher None
    where nobody listens.
    """

    def __init__(self, channels, publishers, every, heard, recording, made_for):
        self.made_for = made_for
        self.wanted = [(channel, publisher if listens else None, ticks)
                       for channel, publisher, listens, ticks
                       in zip(channels, publishers, heard, every)
                       if ticks and (listens or recording)]
        self._intervals = sorted({ticks for _, _, ticks in self.wanted})
        self._due = list(Counter(filter(None, every)).items())

    def ticks_to_wanted(self, tick):
        """Return how many ticks it is to the next one with a wanted message; None: for ever."""
        if not self._intervals:
            return None
        if self._intervals[0] == 1:
            return 1
        return min(ticks - tick % ticks for ticks in self._intervals)

    def due_between(self, first, last):
        """Return how many messages are due at the ticks first + 1 to last, wanted or not."""
        return sum(count * (last // ticks - first // ticks) for ticks, count in self._due)
