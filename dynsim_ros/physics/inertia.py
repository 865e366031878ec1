# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Inertia of the bodies of a scene about their centre of mass, in body axes."""

import numpy as np

from .vector import cross, dot, scale
from ..scene import Box, RigidBody, Sphere


def sphere_inertia(mass, radius):
    """Return 2/5 m r^2 [kg m^2] (sheet, 3.2)."""
    return 0.4 * mass * radius * radius


def cube_inertia(mass, edge):
    """Return m a^2 / 6 [kg m^2], the same about every axis."""
    return mass * edge * edge / 6.0


def box_inertia(mass, size):
    """Return the principal moments m (b^2 + c^2) / 12, ...: (3,) [kg m^2]; size: (3,) edges."""
    a, b, c = (edge * edge for edge in size)
    return (mass * (b + c) / 12.0, mass * (a + c) / 12.0, mass * (a + b) / 12.0)


def body_inertia(body):
    """Return one number if the inertia is the same about every axis, else a (3, 3) array."""
    if isinstance(body, Sphere):
        return sphere_inertia(body.mass, body.radius)
    if isinstance(body, Box):
        if len(set(body.size)) == 1:
            return cube_inertia(body.mass, body.size[0])
        return np.diag(box_inertia(body.mass, body.size))
    if isinstance(body, RigidBody):
        return _given_inertia(body.inertia)
    raise TypeError(f'{body.name} is a particle and has no inertia')


def _given_inertia(inertia):
    if isinstance(inertia, float):
        return inertia
    given = np.array(inertia)
    matrix = np.diag(given) if given.ndim == 1 else given
    if np.array_equal(matrix, matrix[0, 0] * np.eye(3)):
        return float(matrix[0, 0])
    return matrix


def inverse(matrix):
    """
    Return the inverse of an inertia matrix: (3, 3) [1 / (kg m^2)].

    By cofactors, not by a library: those differ in the last bits from machine to machine.
    """
    rows = [tuple(row) for row in matrix.tolist()]
    cofactors = [cross.py_func(rows[1], rows[2]), cross.py_func(rows[2], rows[0]),
                 cross.py_func(rows[0], rows[1])]
    determinant = dot.py_func(rows[0], cofactors[0])
    return np.array([scale.py_func(1.0 / determinant, column) for column in cofactors]).T
