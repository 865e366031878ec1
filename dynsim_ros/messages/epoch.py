# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The number of the epoch: how often a run was reset."""

from .cdr import encode
from .channel import Channel
from .qos import LATCHED

_TYPE = 'std_msgs/msg/UInt64'


def encode_epoch(snapshot, _stamp_ns):
    """Return the message for the epoch of a snapshot."""
    return encode(_TYPE, {'data': snapshot.epoch})


EPOCH = Channel('epoch', _TYPE, encode_epoch, LATCHED)
