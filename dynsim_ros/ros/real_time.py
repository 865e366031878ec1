# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
What makes a thread be on time, as far as the operating system permits it.

Each of these only asks for it: where it is not granted, a line says so and the run goes on.
"""

import ctypes
import os

_PR_SET_TIMERSLACK = 29
_MCL_CURRENT, _MCL_FUTURE = 1, 2


def end_timer_slack():
    """Let the calling thread be woken on time (1 ns), not up to 50 us later; Linux only."""
    try:
        ctypes.CDLL(None).prctl(_PR_SET_TIMERSLACK, 1, 0, 0, 0)
    except (AttributeError, OSError):
        pass  # another system, which has no such slack or does not tell


def be_first(priority):
    """Give the calling thread a priority of SCHED_FIFO; return why not, None if it has it."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
    except (AttributeError, OSError) as error:
        return (f'real_time.priority: {priority} is not granted ({_reason(error)}); allow it with '
                'an rtprio limit, or run with CAP_SYS_NICE')
    return None


def stay_on(cpu):
    """Keep the calling thread on one processor; return why not, None if it stays there."""
    try:
        os.sched_setaffinity(0, {cpu})
    except (AttributeError, OSError) as error:
        return (f'real_time.cpu: {cpu} is not possible ({_reason(error)}); give one of those that '
                f'the process may use: {sorted(_usable())}')
    return None


def lock_memory():
    """Keep the memory of the process from being paged out; return why not, None if it is kept."""
    try:
        libc = ctypes.CDLL(None, use_errno=True)
        if libc.mlockall(_MCL_CURRENT | _MCL_FUTURE) == 0:
            return None
        reason = os.strerror(ctypes.get_errno())
    except (AttributeError, OSError) as error:
        reason = _reason(error)
    return (f'real_time.lock_memory: is not granted ({reason}); allow it with a memlock limit, or '
            'run with CAP_IPC_LOCK')


def _usable():
    return os.sched_getaffinity(0) if hasattr(os, 'sched_getaffinity') else ()


def _reason(error):
    return getattr(error, 'strerror', None) or str(error)
