# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The functions phi of exponential integrators, for decay: without cancellation at any argument.

Source: Hochbruck and Ostermann, Exponential integrators, Acta Numerica 19 (2010), section 2.1,
with the sign of the argument turned.
"""

import math

from ...physics.elementary import exponential
from ...physics.jit import formula

# 1 / 2!, -1 / 3!, 1 / 4!, ...: what is left out is below 1e-17 for |x| < 1.
_SERIES = tuple((-1.0) ** n / math.factorial(n + 2) for n in range(17))


@formula
def phi_1(x):
    """Return (1 - exp(-x)) / x: the mean of exp(-x s) over s in [0, 1]."""
    if x == 0.0:
        return 1.0
    _, less = exponential(-x)
    return -less / x


@formula
def series_of_phi_2(x):
    """Return phi_2(x) by its power series, even and odd powers side by side; |x| < 1."""
    square = x * x
    even, odd = _SERIES[-1], 0.0
    for n in range(len(_SERIES) - 2, 0, -2):
        odd = odd * square + _SERIES[n]
        even = even * square + _SERIES[n - 1]
    return even + x * odd


@formula
def decay_and_phis(x):
    """
    Return exp(-x), phi_1(x) and phi_2(x).

    phi_2: (exp(-x) - 1 + x) / x^2, the mean of (1 - s) exp(-x s), 1 / 2 at x = 0.
    """
    if abs(x) < 1.0:
        second = series_of_phi_2(x)
        first = 1.0 - x * second
        return 1.0 - x * first, first, second
    decay, _ = exponential(-x)
    # While the exponential is on its way.
    inverse = 1.0 / x
    first = (1.0 - decay) * inverse
    return decay, first, (1.0 - first) * inverse
