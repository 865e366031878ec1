# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A number as the integer that its bits are, and back, compiled and in plain Python."""

import struct

from numba import types
from numba.extending import intrinsic

from .jit import overload
from .lanes import FLOAT

# Of the exponent; bits of what follows it.
BIAS, MANTISSA_BITS = 1023, 52


def bits_of(x):
    """Return the bits of a number as an integer."""
    return struct.unpack('<q', struct.pack('<d', x))[0]


def number_of(bits):
    """Return the number that has some bits."""
    return struct.unpack('<d', struct.pack('<q', bits))[0]


@intrinsic
def _cast_to_bits(typing_context, x):
    def generate(context, builder, sig, args):
        return builder.bitcast(args[0], context.get_value_type(types.int64))
    return types.int64(FLOAT), generate


@intrinsic
def _cast_to_number(typing_context, bits):
    def generate(context, builder, sig, args):
        return builder.bitcast(args[0], context.get_value_type(FLOAT))
    return FLOAT(types.int64), generate


@overload(bits_of)
def _bits_of(x):
    return lambda x: _cast_to_bits(x)


@overload(number_of)
def _number_of(bits):
    return lambda bits: _cast_to_number(bits)
