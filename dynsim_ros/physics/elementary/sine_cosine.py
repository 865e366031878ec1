# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Sine and cosine: by a polynomial each, of an angle less whole quarter turns."""

import math

from .quarter_turns import less_quarters
from ..jit import formula


@formula
def sine_series(z):
    """Return (sin(x) / x - 1) / z; z: x^2."""
    square = z * z
    return ((-0.16666666666666666 + z * 0.008333333333333331)
            + square * (-0.0001984126984126506 + z * 2.7557319219335453e-06)
            + square * square * ((-2.5052106231157904e-08 + z * 1.605853141458901e-10)
                                 - square * 7.586685070091267e-13))


@formula
def cosine_series(z):
    """Return (cos(x) - 1 + z / 2) / z^2; z: x^2."""
    square = z * z
    return ((0.041666666666666664 - z * 0.0013888888888887395)
            + square * (2.4801587298763433e-05 - z * 2.7557317270560326e-07)
            + square * square * (2.0876146024689747e-09 - z * 1.1382614868556325e-11))


@formula
def sine_cosine(x):
    """Return sin(x) and cos(x) of any finite x [rad]; not a number for others."""
    angle, left, count = less_quarters(x)
    z = angle * angle
    half = 0.5 * z
    # A sine of -0 is -0.
    sine = math.copysign(angle + (angle * z * sine_series(z) + left * (1.0 - half)), angle)
    head = 1.0 - half
    cosine = head + (((1.0 - head) - half) + (z * z * cosine_series(z) - angle * left))
    if count & 1:
        sine, cosine = cosine, -sine
    if count & 2:
        return -sine, -cosine
    return sine, cosine
