# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Powers for the control of step lengths: quick, and the same bits on every machine.

The C library's exp, log and pow differ in their last bits from one machine to the next; steps, and
with them all states, would too. Two digits are plenty here, and a next step waits for them.
"""

import struct

from numba import types
from numba.extending import intrinsic, overload

from ..physics.jit import formula
from ..physics.lanes import FLOAT

_BIAS, _MANTISSA_BITS = 1023, 52
_MANTISSA = (1 << _MANTISSA_BITS) - 1
_ONE = _BIAS << _MANTISSA_BITS
# Added to a number, it leaves the whole part in the last bits.
_SHIFT = 1.5 * 2.0 ** _MANTISSA_BITS
# Of parabolas, the best by the largest error.
_BEND, _SAG = 0.3466, 0.3398


def bits_of(x):
    """Return the bits of a number as an integer."""
    return struct.unpack('<q', struct.pack('<d', x))[0]


def number_of(bits):
    """Return the number that has some bits."""
    return struct.unpack('<d', struct.pack('<q', bits))[0]


_SHIFT_BITS = bits_of(_SHIFT)


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


@formula
def binary_logarithm(x):
    """Return log2(x) to within 0.0077; x: positive, finite, not subnormal."""
    bits = bits_of(x)
    exponent = (bits >> _MANTISSA_BITS) - _BIAS
    m = number_of((bits & _MANTISSA) | _ONE) - 1.0
    # Exact at 1 and 2, so that it is continuous.
    return exponent + m * (1.0 + _BEND - _BEND * m)


@formula
def binary_power(x):
    """Return 2^x to within 0.27 %; x: from -1000 to 1000."""
    # The half lets it round down.
    shifted = (x - 0.5) + _SHIFT
    whole = shifted - _SHIFT
    m = x - whole
    return number_of(((bits_of(shifted) - _SHIFT_BITS) << _MANTISSA_BITS) + _ONE) * (
        1.0 + m * (1.0 - _SAG + _SAG * m))
