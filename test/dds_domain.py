# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A DDS domain that no other process on this machine uses."""

import os
import socket

_FIRST, _LAST = 1, 100  # domains whose ports lie below those that Linux hands out by itself


def claim_domain():
    """
    Return the number of a free domain and a socket that keeps it: hold on to it.

    A domain owns 250 UDP ports from 7400 + 250 n. The last of them is bound as the mark that it
    is taken (no participant gets that far), the eleventh is the first participant's: if that is
    bound, somebody else is at work there. The mark goes when the process ends, however it ends.
    """
    count = _LAST - _FIRST + 1
    for step in range(count):
        domain = _FIRST + (os.getpid() + step) % count
        mark = _bound(7400 + 250 * domain + 249)
        if mark is None:
            continue
        participant = _bound(7400 + 250 * domain + 10)
        if participant is not None:
            participant.close()
            return domain, mark
        mark.close()
    raise RuntimeError(f'all DDS domains from {_FIRST} to {_LAST} are in use on this machine')


def _bound(port):
    bound = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        bound.bind(('', port))
    except OSError:
        bound.close()
        return None
    return bound
