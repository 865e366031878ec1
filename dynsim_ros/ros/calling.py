# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Functions of C libraries called from compiled code, by their addresses."""

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

_STATUS, _NUMBER = ir.IntType(32), ir.IntType(64)


@intrinsic
def call(typing_context, function, arguments):
    """
    Return function(*arguments): int32.

    function: its address; arguments: tuple of int64, which stand for pointers, int64 and int.
    """
    def generate(context, builder, sig, args):
        address, given = args
        kind = ir.FunctionType(_STATUS, [_NUMBER] * arguments.count)
        return builder.call(builder.inttoptr(address, kind.as_pointer()),
                            cgutils.unpack_tuple(builder, given, arguments.count))
    return types.int32(types.int64, arguments), generate
