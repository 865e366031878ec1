# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers written into bytes wherever they are to stand, little end first."""

from llvmlite import ir
from numba import types
from numba.extending import intrinsic, overload


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
