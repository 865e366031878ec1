# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Vectors of three numbers, as tuples: the compiler keeps them in registers."""

from .fused import fused
from .jit import formula
from .lanes import root


@formula
def at(array, i):
    """Return the vector that stands in array[i], array[i + 1], array[i + 2]."""
    return (array[i], array[i + 1], array[i + 2])


@formula
def put(array, i, a):
    """Write the vector a to array[i], array[i + 1], array[i + 2]."""
    array[i] = a[0]
    array[i + 1] = a[1]
    array[i + 2] = a[2]


@formula
def accumulate(array, i, a):
    """Add the vector a to array[i], array[i + 1], array[i + 2]."""
    array[i] = array[i] + a[0]
    array[i + 1] = array[i + 1] + a[1]
    array[i + 2] = array[i + 2] + a[2]


@formula
def accumulate_scaled(array, i, s, a):
    """Add s times the vector a to array[i], array[i + 1], array[i + 2]."""
    array[i] = fused(s, a[0], array[i])
    array[i + 1] = fused(s, a[1], array[i + 1])
    array[i + 2] = fused(s, a[2], array[i + 2])


@formula
def add(a, b):
    """Return a + b."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


@formula
def subtract(a, b):
    """Return a - b."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


@formula
def scale(s, a):
    """Return s a."""
    return (s * a[0], s * a[1], s * a[2])


@formula
def dot(a, b):
    """Return the scalar product of a and b."""
    return fused(a[2], b[2], fused(a[1], b[1], a[0] * b[0]))


@formula
def cross(a, b):
    """Return the vector product a x b."""
    return (fused(a[1], b[2], -(a[2] * b[1])), fused(a[2], b[0], -(a[0] * b[2])),
            fused(a[0], b[1], -(a[1] * b[0])))


@formula
def norm(a):
    """Return the length of a."""
    return root(dot(a, a))


@formula
def transform(matrix, a):
    """Return matrix times a; matrix: three rows of three."""
    return (dot(matrix[0], a), dot(matrix[1], a), dot(matrix[2], a))


@formula
def transform_back(matrix, a):
    """Return the transpose of matrix times a; for a rotation matrix that is its inverse."""
    x, y, z = matrix
    return (dot((x[0], y[0], z[0]), a), dot((x[1], y[1], z[1]), a), dot((x[2], y[2], z[2]), a))


@formula
def matrix_product(a, b):
    """Return the product of two matrices, each three rows of three."""
    return (transform_back(b, a[0]), transform_back(b, a[1]), transform_back(b, a[2]))
