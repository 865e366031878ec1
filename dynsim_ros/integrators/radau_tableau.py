# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The coefficients of the Radau IIA method with eight stages, order 15.

Its nodes are the roots of d^(s - 1)/dx^(s - 1) (x^(s - 1) (x - 1)^s), its matrix integrates the
Lagrange polynomials of the nodes from 0 to each node. Computed with 50 digits.

Hairer, Wanner, Solving Ordinary Differential Equations II, IV.5.
"""

from decimal import Decimal, localcontext
from fractions import Fraction
from functools import lru_cache
from math import comb

import numpy as np

from .memory import STAGES

_DIGITS = 50


def _polynomial():
    """Return the integer coefficients, lowest power first, of the polynomial of the nodes."""
    s = STAGES
    powers = [0] * (2 * s)
    for k in range(s + 1):
        powers[s - 1 + k] = comb(s, k) * (-1) ** (s - k)
    for _ in range(s - 1):
        powers = [i * a for i, a in enumerate(powers)][1:]
    return powers


def _value(powers, x):
    total = Decimal(0)
    for a in reversed(powers):
        total = total * x + a
    return total


@lru_cache
def nodes():
    """Return the nodes, ascending, the last one 1: Fractions of 50 digits."""
    powers = _polynomial()
    slope = [i * a for i, a in enumerate(powers)][1:]
    found = []
    with localcontext() as context:
        context.prec = _DIGITS
        # The signs on a grid show where the roots are; Newton's method does the rest.
        grid = [Decimal(i) / 400 for i in range(400)]
        for a, b in zip(grid, grid[1:]):
            if _value(powers, a) * _value(powers, b) < 0:
                x = (a + b) / 2
                for _ in range(12):
                    x -= _value(powers, x) / _value(slope, x)
                found.append(Fraction(x))
    return [*found, Fraction(1)]


@lru_cache
def matrix():
    """Return the rows of the matrix A, Fractions of some 50 digits."""
    c = nodes()
    columns = []
    for j in range(STAGES):
        powers = [Fraction(1)]
        for k in range(STAGES):
            if k != j:
                scale = 1 / (c[j] - c[k])
                powers = [scale * ((powers[i - 1] if i else 0)
                                   - c[k] * (powers[i] if i < len(powers) else 0))
                          for i in range(len(powers) + 1)]
        columns.append([sum_of(a * x ** (i + 1) / (i + 1) for i, a in enumerate(powers))
                        for x in c])
    return [[column[i] for column in columns] for i in range(STAGES)]


def sum_of(terms):
    """Return the sum of Fractions."""
    total = Fraction(0)
    for term in terms:
        total += term
    return total.limit_denominator(10 ** _DIGITS)


# Places in the packed table: nodes, columns of A, columns of A^2, weights of the error estimate,
# and of the slope that the polynomial through the stages has at the start, one over the product of
# the differences of each node to the others.
NODES = 0
A = STAGES
A2 = A + STAGES * STAGES
ERROR = A2 + STAGES * STAGES
SLOPE = ERROR + STAGES
LAGRANGE = SLOPE + STAGES
# The node whose value the error estimate compares with the interpolation of the others.
_LEFT_OUT = 3
# That difference has the power 8 of the step, the error at the end 16, or 9 where springs are too
# stiff for it; this part of it is still above the error.
CAUTION = 0.01


@lru_cache
def table():
    """Return all coefficients in one array."""
    a, c = matrix(), nodes()
    packed = np.zeros(LAGRANGE + STAGES)
    packed[:STAGES] = c
    for i in range(STAGES):
        for j in range(STAGES):
            packed[A + STAGES * j + i] = a[i][j]
            packed[A2 + STAGES * j + i] = sum_of(a[i][k] * a[k][j] for k in range(STAGES))
    x = c[_LEFT_OUT]
    for j in range(STAGES):
        weight = Fraction(1)
        for k, other in enumerate([Fraction(0), *c]):
            if k - 1 not in (j, _LEFT_OUT):
                weight *= (x - other) / (c[j] - other)
        slope, lagrange = 1 / c[j], Fraction(1)
        for k, other in enumerate(c):
            if k != j:
                slope *= other / (other - c[j])
                lagrange /= c[j] - other
        packed[SLOPE + j], packed[LAGRANGE + j] = slope, lagrange
        packed[ERROR + j] = CAUTION * float(-1 if j == _LEFT_OUT else weight)
    return packed
