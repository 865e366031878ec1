# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""One topic of a run: its name and type, and how its messages come out of a snapshot."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from .qos import Qos, STATE
from .row import Row

WORLD = 'world'
# How often what is only to be looked at has to come.
FOR_VIEWERS_NS = 40_000_000
_SECOND = 1_000_000_000


@dataclass(frozen=True)
class Channel:
    """
    A topic that is published from the state of a run.

    topic: relative to the node, such as 'sphere/pose', or a full name; type_name: of its messages;
    encode(snapshot, stamp_ns): returns one message as CDR bytes, None where there is a row: Row,
    how a kernel fills it in; interval_ns: the time that passes at least between two messages
    [ns], 0 for every tick.
    """

    topic: str
    type_name: str
    encode: Callable | None
    qos: Qos = STATE
    interval_ns: int = 0
    row: Row | None = None

    def every(self, tick_ns: int) -> int:
        """Return how many ticks of a length [ns] it is from one message to the next."""
        return max(-(-self.interval_ns // tick_ns), 1)

    def is_due(self, tick: int, tick_ns: int) -> bool:
        """Tell whether a tick is one at which this channel has a message."""
        return tick % self.every(tick_ns) == 0


def stamp(stamp_ns: int) -> tuple[int, int]:
    """Return (sec, nanosec) of a time [ns]."""
    return divmod(stamp_ns, _SECOND)


def header(stamp_ns: int) -> dict:
    """Return a std_msgs/Header in the world frame."""
    sec, nanosec = stamp(stamp_ns)
    return {'stamp': {'sec': sec, 'nanosec': nanosec}, 'frame_id': WORLD}
