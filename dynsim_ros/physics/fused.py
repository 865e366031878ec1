# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
a b + c with a single rounding, of numbers or Lanes: one instruction instead of two.

The compiler never fuses on its own, so that results do not depend on the machine; where it is
written here it is fused on all of them, and in plain Python too.
"""

import ctypes
from fractions import Fraction
import math

from llvmlite import ir
from numba import types
from numba.extending import intrinsic
import numpy as np

from .jit import overload
from .lanes import as_vector, COUNT, FLOAT, LANES, VECTOR


def fused(a, b, c):
    """Return a b + c, rounded once; each a number or Lanes. Other kinds of numbers are exact."""
    if any(isinstance(x, np.ndarray) for x in (a, b, c)):
        return _fused_each(a, b, c).astype(float)
    if all(isinstance(x, (float, int)) for x in (a, b, c)):
        return fused_numbers(a, b, c)
    return a * b + c


def fused_by_fractions(a, b, c):
    """Return a b + c of floats, rounded once, where there is nothing quicker."""
    if not (math.isfinite(a) and math.isfinite(b)):
        return a * b + c
    if not math.isfinite(c):
        return c
    exact = Fraction(a) * Fraction(b) + Fraction(c)
    if not exact:
        # A zero has a sign.
        return a * b + c
    try:
        return float(exact)
    except OverflowError:
        return math.inf if exact > 0 else -math.inf


def _fused_by_c():
    """Return what the C library has for it, which has to round once, too; None without it."""
    try:
        found = ctypes.CDLL(None).fma
    except (AttributeError, OSError, TypeError):
        return None
    found.restype, found.argtypes = ctypes.c_double, [ctypes.c_double] * 3
    return found


def rounded_twice(a, b, c):
    """Return a b + c as Python computes it: a tenth of the time."""
    return a * b + c


fused_numbers = _fused_by_c() or fused_by_fractions
_fused_each = np.frompyfunc(fused_numbers, 3, 1)
# What stands in plain Python for what serves for Lanes, too: to the same bits, or in less time.
EXACTLY = {'fused': fused_numbers, 'root': math.sqrt}
QUICKLY = {'fused': rounded_twice, 'root': math.sqrt}


@intrinsic
def _fused_numbers(typing_context, a, b, c):
    def generate(context, builder, sig, args):
        return builder.fma(*args)
    return FLOAT(FLOAT, FLOAT, FLOAT), generate


@intrinsic
def _fused_lanes(typing_context, a, b, c):
    def generate(context, builder, sig, args):
        function = builder.module.declare_intrinsic(
            f'llvm.fma.v{COUNT}f64', fnty=ir.FunctionType(VECTOR, [VECTOR] * 3))
        return builder.call(function, [as_vector(builder, *pair)
                                       for pair in zip(args, sig.args)])
    return LANES(a, b, c), generate


@overload(fused)
def _overload(a, b, c):
    if LANES in (a, b, c):
        return lambda a, b, c: _fused_lanes(a, b, c)
    if all(isinstance(x, types.Float) for x in (a, b, c)):
        return lambda a, b, c: _fused_numbers(a, b, c)
    return None
