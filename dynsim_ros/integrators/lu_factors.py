# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The factors L and U of a matrix in the memory, and the solution of equations with them.

Its columns lie in a row; there is a whole number of Lanes in each.
"""

from ..physics.jit import formula
from ..physics.lanes import COUNT, lanes_at, put_lanes


@formula
def largest_below(count, memory, column, k):
    """Return the row of the number of largest size in a column, from row k on."""
    pivot, largest = k, abs(memory[column + k])
    for i in range(k + 1, count):
        size = abs(memory[column + i])
        if size > largest:
            pivot, largest = i, size
    return pivot


@formula
def subtract_below(count, memory, column, k, factor, target):
    """Subtract a column times a factor from another one, in the rows below k."""
    four = k + 1 + -(k + 1) % COUNT
    for i in range(k + 1, four):
        memory[target + i] -= factor * memory[column + i]
    for i in range(four, count, COUNT):
        put_lanes(memory, target + i,
                  lanes_at(memory, target + i) - factor * lanes_at(memory, column + i))


@formula
def subtract_above(memory, column, k, factor, target):
    """Subtract a column times a factor from another one, in the rows above k."""
    four = k - k % COUNT
    for i in range(0, four, COUNT):
        put_lanes(memory, target + i,
                  lanes_at(memory, target + i) - factor * lanes_at(memory, column + i))
    for i in range(four, k):
        memory[target + i] -= factor * memory[column + i]


@formula
def factorise(count, memory, matrix, pivots):
    """Replace a matrix, columns in a row, by its factors L and U, the diagonal inverted."""
    for k in range(count):
        column = matrix + count * k
        pivot = largest_below(count, memory, column, k)
        memory[pivots + k] = pivot
        if pivot != k:
            for j in range(count):
                a, b = matrix + count * j + k, matrix + count * j + pivot
                memory[a], memory[b] = memory[b], memory[a]
        inverse = 1.0 / memory[column + k]
        memory[column + k] = inverse
        for i in range(k + 1, count):
            memory[column + i] *= inverse
        for j in range(k + 1, count):
            target = matrix + count * j
            subtract_below(count, memory, column, k, memory[target + k], target)


@formula
def substitute(count, memory, matrix, pivots, x):
    """Replace memory[x:] by the solution of a system whose matrix was factorised."""
    for k in range(count):
        pivot = int(memory[pivots + k])
        memory[x + k], memory[x + pivot] = memory[x + pivot], memory[x + k]
    for k in range(count):
        subtract_below(count, memory, matrix + count * k, k, memory[x + k], x)
    for k in range(count - 1, -1, -1):
        column = matrix + count * k
        memory[x + k] *= memory[column + k]
        subtract_above(memory, column, k, memory[x + k], x)
