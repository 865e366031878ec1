# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Powers for the control of step lengths: quick, and the same bits on every machine.

The C library's exp, log and pow differ in their last bits from one machine to the next; steps, and
with them all states, would too. Three digits are plenty here.
"""

from ..physics.bits import BIAS, bits_of, MANTISSA_BITS, number_of
from ..physics.jit import formula

_MANTISSA = (1 << MANTISSA_BITS) - 1
_ONE = BIAS << MANTISSA_BITS


@formula
def binary_logarithm(x):
    """Return log2(x) to within 3e-5; x: positive, finite, not subnormal."""
    bits = bits_of(x)
    exponent = (bits >> MANTISSA_BITS) - BIAS
    m = number_of((bits & _MANTISSA) | _ONE) - 1.0
    # Exact at 1 and 2, so that it is continuous.
    return exponent + m * (1.0 + (1.0 - m) * (
        0.44174 + m * (-0.26605 + m * (0.14635 - m * 0.04402))))


@formula
def binary_power(x):
    """Return 2^x to within a factor of 1 + 1e-5; x: from -1000 to 1000."""
    whole = int(x + 1024.0) - 1024
    m = x - whole
    return number_of((whole + BIAS) << MANTISSA_BITS) * (
        1.0 + m * (1.0 + (m - 1.0) * (0.306945 + m * (0.065548 + m * 0.013704))))
