# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The hash of the whole state, once a second of simulated time, as text: tick, time [ns], hash."""

from __future__ import annotations

from typing import NamedTuple

from .cdr import decode, encode
from .channel import Channel
from ..simulation.settings import SECOND
from ..simulation.state_hash import state_hash

_TYPE = 'std_msgs/msg/String'


class HashedState(NamedTuple):
    """What a message says: number of the tick, simulated time [ns], 64 hexadecimal digits."""

    tick: int
    time_ns: int
    digits: str


def encode_state_hash(snapshot, _stamp_ns):
    """Return the message for a Snapshot."""
    # As long as any other, so that the messages of a bag make an array.
    return encode(_TYPE, {
        'data': f'{snapshot.tick:>19} {snapshot.time_ns:>19} {state_hash(snapshot)}'})


def decode_state_hash(data: bytes) -> HashedState:
    """Return what CDR bytes say; raises ValueError for what is no such message."""
    tick, time_ns, digits = decode(_TYPE, data)['data'].split()
    return HashedState(int(tick), int(time_ns), digits)


STATE_HASH = Channel('state_hash', _TYPE, encode_state_hash, interval_ns=SECOND)
