# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Principal axes of inertia, by Jacobi's rotations in plain Python.

No library: those differ in the last bits from machine to machine.
"""

import math

_PAIRS = ((0, 1, 2), (0, 2, 1), (1, 2, 0))
# Jacobi's method converges quadratically: five or six sweeps are usual.
_SWEEPS = 30


def principal_axes(inertia):
    """
    Return the principal moments, ascending, and the principal axes, which are right-handed.

    inertia: (3, 3) symmetric, positive definite, in body axes [kg m^2]. Returns a tuple of three
    moments [kg m^2] and a tuple of three axes (3,), unit vectors in body axes: rows of the matrix
    that takes components in body axes to those along principal axes. A diagonal matrix gives its
    own numbers and axes of exact zeros and ones.
    """
    matrix = [[float(number) for number in row] for row in inertia]
    axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    for _ in range(_SWEEPS):
        turns = [_annihilate(matrix, axes, *pair) for pair in _PAIRS]
        if not any(turns):
            break
    order = sorted(range(3), key=lambda i: matrix[i][i])
    moments = tuple(matrix[i][i] for i in order)
    first, second = axes[order[0]], axes[order[1]]
    third = axes[order[2]]
    if order not in ([0, 1, 2], [1, 2, 0], [2, 0, 1]):
        third = [-component for component in third]
    return moments, (tuple(first), tuple(second), tuple(third))


def _annihilate(matrix, axes, i, j, k):
    """Turn axes i and j until matrix[i][j] is zero; return whether it was not."""
    off = matrix[i][j]
    # Relative to both diagonal elements: a small moment keeps its digits (Demmel and Veselic,
    # Jacobi's method is more accurate than QR, SIAM J. Matrix Anal. Appl. 13 (1992)).
    if abs(off) <= 2.0 ** -54 * math.sqrt(matrix[i][i]) * math.sqrt(matrix[j][j]):
        return False
    # Golub and Van Loan, Matrix Computations (2013), algorithm 8.5.1.
    ratio = (matrix[j][j] - matrix[i][i]) / (2.0 * off)
    tangent = math.copysign(1.0, ratio) / (abs(ratio) + math.sqrt(1.0 + ratio * ratio))
    c = 1.0 / math.sqrt(1.0 + tangent * tangent)
    s = tangent * c
    matrix[i][i] -= tangent * off
    matrix[j][j] += tangent * off
    matrix[i][j] = matrix[j][i] = 0.0
    a, b = matrix[i][k], matrix[j][k]
    matrix[i][k] = matrix[k][i] = c * a - s * b
    matrix[j][k] = matrix[k][j] = s * a + c * b
    for n in range(3):
        a, b = axes[i][n], axes[j][n]
        axes[i][n], axes[j][n] = c * a - s * b, s * a + c * b
    return True
