# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a bag lacks of what was to be recorded, as the bag itself tells it."""

from __future__ import annotations

# Metadata records of this name, with a number behind it, tell of gaps.
MISSING = 'missing_'


class Gap:
    """
    Messages, one after the other, that could not be stored.

    reason: one line; messages: how many; first_ns, last_ns: times of the first and the last one.
    """

    def __init__(self, reason: str, stamp_ns: int):
        """Begin at a time, with no message yet."""
        self.reason = reason
        self.messages = 0
        self.first_ns = self.last_ns = stamp_ns

    def add(self, stamp_ns: int, count: int):
        """Take in so many more messages of one time."""
        self.messages += count
        self.last_ns = max(self.last_ns, stamp_ns)

    def values(self) -> dict[str, str]:
        """Return what a metadata record tells of it."""
        return {'messages': str(self.messages), 'first_ns': str(self.first_ns),
                'last_ns': str(self.last_ns), 'reason': self.reason}

    def __str__(self) -> str:
        """Return it as a part of a line."""
        return (f'{self.messages} messages from {self.first_ns * 1e-9:.3f} s to '
                f'{self.last_ns * 1e-9:.3f} s are missing: {self.reason}')
