# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
How the rows of a tick are published: as they stand in their block, by one compiled call.

rclpy's publish() takes longer than all that rcl and DDS do for a message that nobody receives, and
does it under the interpreter's lock. rcl's own function takes the bytes where they are.
"""

import ctypes
from typing import NamedTuple

import numba
import numpy as np

from .calling import call
from .layout_check import typed_message
from ..integrators.entry import entry
from ..messages.cdr import decode
from ..messages.tick_rows import TickRows
from ..physics.jit import formula, kernel


class _Allocator(ctypes.Structure):
    """rcutils_allocator_t."""

    _fields_ = [(name, ctypes.c_void_p) for name in
                ('allocate', 'deallocate', 'reallocate', 'zero_allocate', 'state')]


class _Message(ctypes.Structure):
    """rcutils_uint8_array_t, which rcl calls a serialized message."""

    _fields_ = [('buffer', ctypes.c_void_p), ('length', ctypes.c_size_t),
                ('capacity', ctypes.c_size_t), ('allocator', _Allocator)]


_WORDS = ctypes.sizeof(_Message) // 8


class Rows(NamedTuple):
    """
    What compiled code needs to publish rows; all numbers but `offsets` and `stride` are addresses.

    publish: of rcl's function; publishers: (n,); messages: (n, 8) int64, as _Message, and where
    they are; blocks: of the first block; stride: from one block to the next; offsets: (n,) of the
    messages in a block.
    """

    publish: int
    publishers: np.ndarray
    messages: np.ndarray
    at: np.ndarray
    blocks: int
    stride: int
    offsets: np.ndarray


@formula
def publish_block(rows, k):
    """Publish the rows of block k; return how many, up to the first that fails."""
    for i in range(rows.publishers.shape[0]):
        rows.messages[i, 0] = rows.blocks + k * rows.stride + rows.offsets[i]
        if call(rows.publish, (rows.publishers[i], rows.at[i], 0)) != 0:
            return i
    return rows.publishers.shape[0]


@kernel
def _publish(rows):
    return publish_block(rows, 0)


def prepare_sending():
    """Compile, or load from the disk cache, the kernel; return it, see entry."""
    return entry(_publish, no_rows())


def no_rows():
    """Return Rows without any, for their type."""
    none = np.zeros(0, np.int64)
    return Rows(0, none, np.zeros((0, _WORDS), np.int64), none, 0, 0, none)


class Rcl:
    """
    The function of rcl that publishes bytes.

    publish: its address, None where it cannot be called: without compiled code, or by a rcl that
    lays out what it takes in another way.
    """

    def __init__(self):
        self.publish, self.forget_error = None, None
        if numba.config.DISABLE_JIT:
            return
        try:
            rcl, rcutils = ctypes.CDLL('librcl.so'), ctypes.CDLL('librcutils.so')
            if _is_as_expected(rcutils):
                self.publish = ctypes.cast(rcl.rcl_publish_serialized_message,
                                           ctypes.c_void_p).value
                self.forget_error = rcutils.rcutils_reset_error
        except (AttributeError, OSError):
            pass  # another rcl, or one that is linked in


def _is_as_expected(rcutils):
    """Tell whether rcutils fills in an array of bytes where _Message has its parts."""
    rcutils.rcutils_get_default_allocator.restype = _Allocator
    allocator = rcutils.rcutils_get_default_allocator()
    message = _Message(length=1)
    status = rcutils.rcutils_uint8_array_init(
        ctypes.byref(message), ctypes.c_size_t(48), ctypes.byref(allocator))
    found = message.length, message.capacity, bytes(message.allocator)
    rcutils.rcutils_uint8_array_fini(ctypes.byref(message))
    return status == 0 and found == (0, 48, bytes(allocator))


class Together:
    """
    Publishes some rows of TickRows by one call; pairs: [(row number, publisher)].

    rows: what compiled code needs for it.
    """

    def __init__(self, rcl: Rcl, tick_rows: TickRows, pairs):
        self._rcl, self._tick_rows, self._pairs = rcl, tick_rows, pairs
        messages = np.zeros((len(pairs), _WORDS), np.int64)
        spans = np.array([tick_rows.spans[i] for i, _ in pairs], np.int64).reshape(-1, 2)
        messages[:, 1] = messages[:, 2] = spans[:, 1] - spans[:, 0]
        self.rows = Rows(
            rcl.publish,
            np.array([publisher.handle.pointer for _, publisher in pairs], np.int64),
            messages, messages.ctypes.data + np.arange(len(pairs)) * messages.strides[0],
            tick_rows.reserved.ctypes.data, tick_rows.size, spans[:, 0].copy())
        self._publish = prepare_sending()

    def __call__(self):
        """Publish what the rows hold; raise what publish() raises."""
        sent = self._publish(self.rows)
        if sent < len(self._pairs):
            self._rcl.forget_error()
            # Says why, too.
            OneByOne(self._tick_rows, self._pairs[sent:])()


class OneByOne:
    """Does the same by publish()."""

    def __init__(self, rows: TickRows, pairs):
        self._rows, self._pairs = rows, pairs

    def __call__(self):
        """Publish what the rows hold."""
        for i, publisher in self._pairs:
            publisher.publish(self._rows.message(i))


class Typed:
    """Does the same with messages that ROS serialises, whatever its layout is."""

    def __init__(self, rows: TickRows, pairs):
        self._rows, self._pairs = rows, pairs

    def __call__(self):
        """Publish what the rows hold."""
        for i, publisher in self._pairs:
            name = self._rows.channels[i].type_name
            publisher.publish(typed_message(name, decode(name, self._rows.message(i))))


class Sending:
    """
    Chooses how the rows of TickRows are published.

    is_laid_out: whether ROS serialises messages as the rows lay them out, see layout_check.
    """

    def __init__(self, rows: TickRows, is_laid_out=True):
        self._rows, self._is_laid_out = rows, is_laid_out
        self._rcl = Rcl()

    def of(self, pairs):
        """Return a function that publishes [(row number, publisher)] each time it is called."""
        if not self._is_laid_out:
            return Typed(self._rows, pairs)
        if self._rcl.publish is None:
            return OneByOne(self._rows, pairs)
        return Together(self._rcl, self._rows, pairs)
