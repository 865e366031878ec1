# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How precisely the operating system wakes a thread."""

import ctypes

_PR_SET_TIMERSLACK = 29


def end_timer_slack():
    """Let the calling thread be woken on time (1 ns), not up to 50 us later; Linux only."""
    try:
        ctypes.CDLL(None).prctl(_PR_SET_TIMERSLACK, 1, 0, 0, 0)
    except (AttributeError, OSError):
        pass  # another system, which has no such slack or does not tell
