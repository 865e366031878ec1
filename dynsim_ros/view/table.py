# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The messages of a topic as numbers: one row for each message."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

# How many numbers a message ends with: position and quaternion (x, y, z, w); two vectors;
# energies.
NUMBERS = {'geometry_msgs/msg/PoseStamped': 7, 'geometry_msgs/msg/TwistStamped': 6,
           'geometry_msgs/msg/WrenchStamped': 6, 'std_msgs/msg/Float64MultiArray': 9}

# Times are whole nanoseconds, and rounded as numbers of seconds [s].
_ROUNDING = 0.5e-9


class Table(NamedTuple):
    """Times (n,) [s], ascending, and numbers (n, k) of the messages of a topic."""

    time: np.ndarray
    values: np.ndarray

    def at(self, time):
        """Return the row that holds at a time [s]: the last one before it, or the first one."""
        return self.values[max(int(np.searchsorted(self.time, time + _ROUNDING)) - 1, 0)]

    def between(self, start, end):
        """Return (first, last + 1) of the rows from one time to another [s]."""
        return (int(np.searchsorted(self.time, start - _ROUNDING)),
                int(np.searchsorted(self.time, end + _ROUNDING)))


def numbers(type_name, messages):
    """Return the numbers of messages, CDR bytes of one length: (n, k), see NUMBERS."""
    count = NUMBERS[type_name]
    rows = np.frombuffer(b''.join(messages), np.uint8).reshape(len(messages), -1)
    return np.ascontiguousarray(rows[:, -8 * count:]).view('<f8')


def stamps(messages):
    """Return the stamps of messages with a header, CDR bytes of one length: (n,) [s]."""
    rows = np.frombuffer(b''.join(messages), np.uint8).reshape(len(messages), -1)
    seconds, nanoseconds = np.ascontiguousarray(rows[:, 4:12]).view('<u4').T
    return seconds.astype('<i4') + 1e-9 * nanoseconds
