# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Matrices of fractions, from which the tables of the methods come without rounding."""

from fractions import Fraction


def total(fractions):
    """Return the sum, which is exact in any order."""
    found = Fraction(0)
    for fraction in fractions:
        found += fraction
    return found


def inverse(rows):
    """Return the inverse of a matrix of fractions, as rows."""
    count = len(rows)
    rows = [list(row) + [Fraction(int(i == j)) for j in range(count)]
            for i, row in enumerate(rows)]
    for i in range(count):
        pivot = next(k for k in range(i, count) if rows[k][i])
        rows[i], rows[pivot] = rows[pivot], rows[i]
        rows[i] = [x / rows[i][i] for x in rows[i]]
        for k in range(count):
            if k != i and rows[k][i]:
                rows[k] = [x - rows[k][i] * y for x, y in zip(rows[k], rows[i])]
    return [row[count:] for row in rows]
