# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Powers for the control of step lengths: quick, and the same bits on every machine.

The C library's exp, log and pow differ in their last bits from one machine to the next; steps, and
with them all states, would too. Two digits are plenty here, and a next step waits for them.
"""

from ..physics.bits import BIAS, bits_of, MANTISSA_BITS, number_of
from ..physics.jit import formula

_MANTISSA = (1 << MANTISSA_BITS) - 1
_ONE = BIAS << MANTISSA_BITS
# Added to a number, it leaves the whole part in the last bits.
_SHIFT = 1.5 * 2.0 ** MANTISSA_BITS
_SHIFT_BITS = bits_of(_SHIFT)
# Of parabolas, the best by the largest error.
_BEND, _SAG = 0.3466, 0.3398


@formula
def binary_logarithm(x):
    """Return log2(x) to within 0.0077; x: positive, finite, not subnormal."""
    bits = bits_of(x)
    exponent = (bits >> MANTISSA_BITS) - BIAS
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
    return number_of(((bits_of(shifted) - _SHIFT_BITS) << MANTISSA_BITS) + _ONE) * (
        1.0 + m * (1.0 - _SAG + _SAG * m))
