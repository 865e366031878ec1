# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Where threads run that another one has begun."""

from contextlib import suppress
import os


def use_any_processor():
    """
    Let the calling thread run wherever the process may.

    A thread begins where the one that began it may run: one that ticks may have to stay on one
    processor, and whatever else runs there would be in its way.
    """
    with suppress(AttributeError, OSError):
        os.sched_setaffinity(0, os.sched_getaffinity(os.getpid()))
