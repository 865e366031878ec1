# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The numbers in a bag, as mcap-ros2-support reads them."""

from functools import cache

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
import numpy as np


@cache
def rows(path, topic):
    """Return (n,) times [s] and (n, k) numbers of the messages of a topic below /dynsim."""
    times, values = [], []
    with open(path, 'rb') as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        for _, _, message, decoded in reader.iter_decoded_messages([f'/dynsim/{topic}']):
            times.append(message.log_time * 1e-9)
            values.append(_numbers(decoded))
    return np.array(times), np.array(values)


def row(path, topic, time):
    """Return the numbers of the message that holds at a time [s]."""
    times, values = rows(path, topic)
    return values[np.searchsorted(times, time + 1e-6) - 1]


def _numbers(message):
    """Return the numbers of a pose, a twist, a wrench or of energies, in order."""
    if hasattr(message, 'data'):
        return list(message.data)
    (parts,) = (getattr(message, name) for name in ('pose', 'twist', 'wrench')
                if hasattr(message, name))
    return [getattr(part, axis) for name in parts.__slots__ for part in [getattr(parts, name)]
            for axis in ('x', 'y', 'z', 'w') if hasattr(part, axis)]
