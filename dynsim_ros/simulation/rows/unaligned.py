# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers written into bytes wherever they are to stand, little end first; bytes copied."""

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from ...physics.jit import overload


def put_number(data, i, number):
    """Write a number, of a numpy type, to the bytes data[i], data[i + 1], …."""
    data[i:i + number.nbytes] = bytearray(number.astype(number.dtype.newbyteorder('<')).tobytes())


@intrinsic
def _store(typing_context, data, i, number):
    def generate(context, builder, sig, args):
        address = builder.gep(context.make_array(sig.args[0])(context, builder, args[0]).data,
                              [args[1]])
        address = builder.bitcast(address, ir.PointerType(args[2].type))
        # Alignment 1: a message may begin anywhere.
        builder.store(args[2], address).align = 1
        return context.get_dummy_value()
    return types.none(data, types.intp, number), generate


@overload(put_number, inline='always')
def _put_number(data, i, number):
    return lambda data, i, number: _store(data, i, number)


def copy_bytes(data, at, source, start, size):
    """Copy so many bytes from source[start:] to data[at:]; the two do not overlap."""
    data[at:at + size] = source[start:start + size]


@intrinsic
def _copy(typing_context, data, at, source, start, size):
    def generate(context, builder, sig, args):
        into, out_of = (
            builder.gep(context.make_array(sig.args[i])(context, builder, args[i]).data,
                        [args[i + 1]]) for i in (0, 2))
        cgutils.raw_memcpy(builder, into, out_of, args[4], 1)
        return context.get_dummy_value()
    return types.none(data, types.intp, source, types.intp, types.intp), generate


@overload(copy_bytes, inline='always')
def _copy_bytes(data, at, source, start, size):
    return lambda data, at, source, start, size: _copy(data, at, source, start, size)
