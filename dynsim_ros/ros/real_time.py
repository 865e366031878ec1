# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
What makes a thread be on time, as far as the operating system permits it.

Each of these only asks for it: where it is not granted, a line says so and the run goes on.
"""

import ctypes
import os
import platform
import sys
import time

_PR_SET_TIMERSLACK = 29
_MCL_CURRENT, _MCL_FUTURE = 1, 2
# sched_setattr and sched_getattr, for which older C libraries have no function.
_SYSTEM_CALLS = {'x86_64': (314, 315), 'aarch64': (274, 275)}
_RESET_ON_FORK = 1
# The lowest priority of SCHED_FIFO, and how long it is looked at who deserves it [ns].
_LOWEST, _LATELY = 1, 100_000_000
# The shortest turn that the system grants [ns].
_TURN = 100_000


class _Attributes(ctypes.Structure):
    """struct sched_attr, as far as all versions have it."""

    _fields_ = [('size', ctypes.c_uint32), ('policy', ctypes.c_uint32), ('flags', ctypes.c_uint64),
                ('nice', ctypes.c_int32), ('priority', ctypes.c_uint32),
                ('runtime', ctypes.c_uint64), ('deadline', ctypes.c_uint64),
                ('period', ctypes.c_uint64)]


def end_timer_slack():
    """Let the calling thread be woken on time (1 ns), not up to 50 us later; Linux only."""
    try:
        ctypes.CDLL(None).prctl(_PR_SET_TIMERSLACK, 1, 0, 0, 0)
    except (AttributeError, OSError):
        pass  # another system, which has no such slack or does not tell


def take_short_turns():
    """
    Let the calling thread run soon after it has something to do, also where others are running.

    Linux lets that thread go first whose turn ends first; who asks for short ones is hardly kept
    waiting. From 6.12 on, for everybody; others ignore it.
    """
    if sys.platform != 'linux' or platform.machine() not in _SYSTEM_CALLS:
        return
    change, look = _SYSTEM_CALLS[platform.machine()]
    call, attributes = ctypes.CDLL(None).syscall, _Attributes()
    if call(look, 0, ctypes.byref(attributes), ctypes.sizeof(attributes), 0) == 0:
        attributes.runtime, attributes.flags = _TURN, _RESET_ON_FORK
        call(change, 0, ctypes.byref(attributes), 0)


def be_first(priority):
    """Give the calling thread a priority of SCHED_FIFO; return why not, None if it has it."""
    try:
        # Not the threads that it starts.
        policy = os.SCHED_FIFO | os.SCHED_RESET_ON_FORK
        os.sched_setscheduler(0, policy, os.sched_param(priority))
    except (AttributeError, OSError) as error:
        return (f'real_time.priority: {priority} is not granted ({_reason(error)}); allow it with '
                'an rtprio limit, or run with CAP_SYS_NICE')
    return None


def be_like_others():
    """Let the calling thread have no priority any longer, and short turns."""
    os.sched_setscheduler(0, os.SCHED_OTHER | os.SCHED_RESET_ON_FORK, os.sched_param(0))
    take_short_turns()


class Precedence:
    """
    The lowest priority of SCHED_FIFO, for a thread as long as it mostly sleeps.

    Where it is not wanted or not permitted nothing happens.
    """

    def __init__(self, is_wanted):
        self._is_possible, self._is_taken = is_wanted, False
        self._since = self._worked = 0

    def take_or_give_back(self):
        """Let the calling thread have it if it slept more than it worked lately, else not."""
        now = time.monotonic_ns()
        if now - self._since < _LATELY:
            return
        worked = time.thread_time_ns()
        if 2 * (worked - self._worked) > now - self._since:
            self.give_back()
        elif self._is_possible and not self._is_taken:
            self._is_possible = self._is_taken = be_first(_LOWEST) is None
        self._since, self._worked = now, worked

    def give_back(self):
        """Let the calling thread be as others are."""
        if self._is_taken:
            be_like_others()
            self._is_taken = False


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
