# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes of bodies and springs: vertices (n, 3) and triangles (m, 3)."""

import numpy as np


def octants(is_box, dark, steps=12):
    """
    Return the mesh of four of the eight octants of a body of half-width 1: those that alternate.

    is_box: a cube, else a sphere. Both halves together are the body, marked as engineers mark a
    centre of mass, so that every turn of it shows.
    """
    corner = np.linspace(0.0, 1.0, steps + 1)
    u, v = (part.ravel() for part in np.meshgrid(corner, corner, indexing='ij'))
    one = np.ones_like(u)
    # The three faces of a cube's corner, each in its own order of the axes, so that all of them
    # have their outside on the same side.
    faces = [np.stack([one, u, v], 1), np.stack([v, one, u], 1), np.stack([u, v, one], 1)]
    square = np.arange(steps)[:, None] * (steps + 1) + np.arange(steps)
    a, b, c, d = (square + shift for shift in (0, steps + 1, steps + 2, 1))
    cells = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3),
                            np.stack([a, c, d], -1).reshape(-1, 3)])
    vertices, triangles, count = [], [], 0
    for signs in np.array(np.meshgrid(*[[1, -1]] * 3)).T.reshape(-1, 3):
        if (signs.prod() < 0) != dark:
            continue
        for face in faces:
            points = face if is_box else face / np.linalg.norm(face, axis=1, keepdims=True)
            vertices.append(points * signs)
            # A mirror image has its outside inside.
            triangles.append(count + (cells if signs.prod() > 0 else cells[:, ::-1]))
            count += len(points)
    return np.concatenate(vertices), np.concatenate(triangles)


def coil(length, radius, wire, turns=9, around=18, sides=6):
    """
    Return the mesh of a spring from (0, 0, 0) to (0, 0, 1), to be stretched along z.

    length: at which its wire is round [m]; radius: of the coil [m]; wire: radius of the wire [m].
    x and y are in m.
    """
    share = np.linspace(0.0, 1.0, turns * around + 1)
    angle = 2.0 * np.pi * turns * share
    # Straight ends, and from there to the full width within half a turn.
    ends = 0.08
    width = radius * np.clip(np.minimum(share, 1.0 - share) / ends - 0.5, 0.0, 1.0)
    path = np.stack([width * np.cos(angle), width * np.sin(angle), length * share], 1)
    along = np.gradient(path, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    first = np.cross(along, np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], 1))
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    second = np.cross(along, first)
    turn = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)
    rings = (path[:, None] + wire * (np.cos(turn)[:, None] * first[:, None]
                                     + np.sin(turn)[:, None] * second[:, None]))
    n = np.arange(len(path) - 1)[:, None] * sides
    i = np.arange(sides)
    a, b = n + i, n + (i + 1) % sides
    triangles = np.concatenate([np.stack([a, b, b + sides], -1).reshape(-1, 3),
                                np.stack([a, b + sides, a + sides], -1).reshape(-1, 3)])
    return rings.reshape(-1, 3) / (1.0, 1.0, length), triangles


def turn_of_z(direction):
    """Return the quaternion (w, x, y, z) that turns the z axis into a direction: (3,), unit."""
    x, y, z = direction
    if z < -0.999999:
        return (0.0, 1.0, 0.0, 0.0)
    quaternion = np.array([1.0 + z, -y, x, 0.0])
    return quaternion / np.linalg.norm(quaternion)


def ellipsoid(body):
    """
    Return the half-axes (3,) [m] and the axes as columns (3, 3) of a solid ellipsoid.

    It has the mass and the inertia of a RigidBody.
    """
    inertia = np.asarray(body.inertia, float)
    matrix = inertia if inertia.ndim == 2 else np.eye(3) * inertia
    moments, axes = np.linalg.eigh(matrix)
    if np.linalg.det(axes) < 0.0:
        axes[:, 0] *= -1.0
    squares = 5.0 * (0.5 * moments.sum() - moments) / body.mass
    return np.sqrt(np.maximum(squares, 1e-3 * squares.max())), axes
