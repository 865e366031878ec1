# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Arithmetic-geometric mean and Carlson's elliptic integral of the first kind."""

import math

from ...physics.jit import formula


# Both converge quadratically or by a factor of 4: these bounds are never reached.
_MOST_MEANS = 40
_MOST_DUPLICATIONS = 60
# The series below leaves out terms of order 8: 0.01 ** 8 = 1e-16, with coefficients below 1 / 10.
_NEAR = 0.01


@formula
def agm(a, b):
    """Return the arithmetic-geometric mean of a > 0 and b >= 0 (DLMF 19.8.1)."""
    for _ in range(_MOST_MEANS):
        mean = 0.5 * (a + b)
        # The next mean differs from this one by (a - b)^2 / (16 mean).
        if abs(a - b) <= 1e-8 * mean:
            return mean
        b = math.sqrt(a * b)
        a = mean
    return a


@formula
def carlson_rf(x, y, z):
    """
    Return R_F(x, y, z), the integral of 1 / (2 sqrt((s + x) (s + y) (s + z))) over s >= 0.

    All >= 0, at most one of them zero. By duplication (B. C. Carlson, Numerical computation of
    real or complex elliptic integrals, Numer. Algorithms 10 (1995), 13-26; DLMF 19.36.1).
    """
    for _ in range(_MOST_DUPLICATIONS):
        mean = (x + y + z) / 3.0
        if max(abs(mean - x), abs(mean - y), abs(mean - z)) <= _NEAR * mean:
            break
        a, b, c = math.sqrt(x), math.sqrt(y), math.sqrt(z)
        shift = a * b + b * c + c * a
        x, y, z = 0.25 * (x + shift), 0.25 * (y + shift), 0.25 * (z + shift)
    mean = (x + y + z) / 3.0
    a, b = (mean - x) / mean, (mean - y) / mean
    c = -a - b
    p = a * b - c * c
    r = a * b * c
    return (1.0 - p / 10.0 + r / 14.0 + p * p / 24.0 - 3.0 * p * r / 44.0 - 5.0 * p * p * p / 208.0
            + 3.0 * r * r / 104.0 + p * p * r / 16.0) / math.sqrt(mean)
