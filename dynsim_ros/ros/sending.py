# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
How the rows of a tick are published: as they stand in their block, by one compiled call.

rclpy's publish() takes longer than all that rcl and DDS do for a message that nobody receives, and
does it under the interpreter's lock. rcl's own function takes the bytes where they are.
"""

import ctypes

from llvmlite import ir
import numba
from numba import types
from numba.extending import intrinsic
import numpy as np

from .layout_check import typed_message
from ..integrators.entry import entry
from ..messages.cdr import decode
from ..messages.tick_rows import TickRows
from ..physics.jit import kernel


class _Allocator(ctypes.Structure):
    """rcutils_allocator_t."""

    _fields_ = [(name, ctypes.c_void_p) for name in
                ('allocate', 'deallocate', 'reallocate', 'zero_allocate', 'state')]


class _Message(ctypes.Structure):
    """rcutils_uint8_array_t, which rcl calls a serialized message."""

    _fields_ = [('buffer', ctypes.c_void_p), ('length', ctypes.c_size_t),
                ('capacity', ctypes.c_size_t), ('allocator', _Allocator)]


@intrinsic
def _call(typing_context, function, publisher, message):
    """Return function(publisher, message, NULL), all given as addresses: 0 for success."""
    def generate(context, builder, sig, args):
        byte, status = ir.IntType(8).as_pointer(), ir.IntType(32)
        kind = ir.FunctionType(status, [byte, byte, byte])
        address, *pointers = (builder.inttoptr(arg, what) for arg, what
                              in zip(args, (kind.as_pointer(), byte, byte)))
        return builder.call(address, [*pointers, ir.Constant(byte, None)])
    return types.int32(types.int64, types.int64, types.int64), generate


@kernel
def _publish(function, publishers, messages):
    """Publish messages, each by its publisher; return how many, up to the first that fails."""
    for i in range(publishers.shape[0]):
        if _call(function, publishers[i], messages[i]) != 0:
            return i
    return publishers.shape[0]


def prepare_sending():
    """Compile, or load from the disk cache, the kernel; return it, see entry."""
    none = np.zeros(0, np.int64)
    return entry(_publish, 0, none, none)


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
    """Publishes some rows of TickRows by one call; pairs: [(row number, publisher)]."""

    def __init__(self, rcl: Rcl, rows: TickRows, pairs):
        self._rcl, self._rows, self._pairs = rcl, rows, pairs
        # Kept, as the numbers below point to it.
        self._block = rows.block
        self._messages = (_Message * len(pairs))()
        for message, (i, _) in zip(self._messages, pairs):
            start, end = rows.spans[i]
            message.buffer = self._block.ctypes.data + start
            message.length = message.capacity = end - start
        first, size = ctypes.addressof(self._messages), ctypes.sizeof(_Message)
        publishers = [publisher.handle.pointer for _, publisher in pairs]
        self._arguments = (rcl.publish, np.array(publishers, np.int64),
                           np.arange(len(pairs), dtype=np.int64) * size + first)
        self._publish = prepare_sending()

    def __call__(self):
        """Publish what the rows hold; raise what publish() raises."""
        sent = self._publish(*self._arguments)
        if sent < len(self._pairs):
            self._rcl.forget_error()
            # Says why, too.
            OneByOne(self._rows, self._pairs[sent:])()


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
        if self._rcl.publish is None or not pairs:
            return OneByOne(self._rows, pairs)
        return Together(self._rcl, self._rows, pairs)
