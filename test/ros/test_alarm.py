# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""An alarm ends a wait of the C library at once, now or later, and is silent after a hush."""

import ctypes
import errno
import threading
import time

from dynsim_ros.ros.alarm import Alarm
import pytest

# What a wait that is not ended early lasts [s], and far more than one that is.
SHORT, LONG = 0.02, 30.0


class Timespec(ctypes.Structure):
    _fields_ = [('seconds', ctypes.c_long), ('nanoseconds', ctypes.c_long)]


@pytest.fixture
def alarm():
    alarm = Alarm()
    if alarm.functions is None:
        pytest.fail('this C library has no sem_clockwait')
    return alarm


def wait(alarm, seconds):
    """Wait as compiled code does; return whether the alarm ended it."""
    function = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_int, ctypes.c_void_p,
                                use_errno=True)(alarm.functions[0])
    until = time.monotonic_ns() + round(seconds * 1e9)
    instant = Timespec(until // 10 ** 9, until % 10 ** 9)
    is_rung = function(alarm.semaphore, time.CLOCK_MONOTONIC, ctypes.byref(instant)) == 0
    assert is_rung or (ctypes.get_errno() == errno.ETIMEDOUT and time.monotonic_ns() >= until)
    return is_rung


def test_it_wakes_who_waits(alarm):
    bell = threading.Timer(SHORT, alarm.ring)
    bell.start()
    assert wait(alarm, LONG)
    assert alarm.flag[0] == 1
    bell.join()


def test_it_wakes_who_waits_next(alarm):
    alarm.ring()
    assert wait(alarm, LONG)


def test_however_often_it_rang_it_is_silent_after_a_hush(alarm):
    for _ in range(3):
        for _ in range(1000):
            alarm.ring()
        alarm.hush()
        assert alarm.flag[0] == 0
        assert not wait(alarm, SHORT)
    alarm.hush()
    assert not wait(alarm, SHORT)
