# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Leapfrog (Störmer-Verlet) with a geometric rotation step: half a drift, a kick, half a drift.

Order 2 and symmetric: run backwards it returns, and where nothing is lost the energy error stays
bounded, with the moments of the springs acting. In a drift a body with a scalar inertia turns
about its constant angular velocity; one with an inertia matrix keeps its angular momentum, with
the angular velocity of the start in the first half and of the end in the second, which is the
adjoint of the first. Forces are those in the middle; where they depend on velocities they are
evaluated twice, with the velocities that the first evaluation predicts for the middle.

Hairer, Lubich, Wanner, Geometric Numerical Integration, I.1.4, II.3 and VII.5.
"""

from .memory import load, number_row, store
from ..physics.jit import formula, kernel
from ..physics.motion import apply_forces, chosen, matrix_at, member
from ..physics.rotation import axis_angle_quaternion, quaternion_product, rotation_matrix
from ..physics.state import (counts, moving_size, normalise, omega_at, put_quaternion, quaternion,
                             quaternion_at, velocity_at, work_at)
from ..physics.vector import accumulate, at, put, scale, transform, transform_back

# An implicit half turn has converged long before; this bounds the work where h omega is too large.
_ITERATIONS = 60


@formula
def in_world(matrix, q, a):
    """Return the matrix, given in body axes, times a vector in world."""
    rotation = rotation_matrix(q)
    return transform(rotation, transform(matrix, transform_back(rotation, a)))


@formula
def turned(q, omega, h):
    """Return the orientation after turning by omega h."""
    return quaternion_product(axis_angle_quaternion(scale(h, omega)), q)


@formula
def turn_round(several, bodies, rigid, round_body, h, y):
    """Turn the bodies with a scalar inertia for a time h."""
    if round_body is not None:
        for k in range(chosen(several, round_body)):
            i = member(several, round_body, k)
            place = quaternion_at(bodies) + 4 * i
            put_quaternion(y, place, turned(quaternion(y, place),
                                            at(y, omega_at(bodies, rigid) + 3 * i), h))


@formula
def turn_general(several, bodies, rigid, general_body, inertia, inverse_inertia, implicit, h, y):
    """Turn the bodies with an inertia matrix for a time h, their angular momenta constant."""
    if general_body is not None:
        for k in range(chosen(several, general_body)):
            i = member(several, general_body, k)
            place, w = quaternion_at(bodies) + 4 * i, omega_at(bodies, rigid) + 3 * i
            start = quaternion(y, place)
            momentum = in_world(matrix_at(inertia, k), start, at(y, w))
            inverse = matrix_at(inverse_inertia, k)
            q = turned(start, at(y, w), h)
            if implicit:
                for _ in range(_ITERATIONS):
                    last = q
                    q = turned(start, in_world(inverse, q, momentum), h)
                    if (abs(q[0] - last[0]) + abs(q[1] - last[1]) + abs(q[2] - last[2])
                            + abs(q[3] - last[3]) < 1e-15):
                        break
            put_quaternion(y, place, q)
            put(y, w, in_world(inverse, q, momentum))


@formula
def drift(model, bodies, rigid, implicit, h, y):
    """Move all bodies for a time h without forces."""
    for i in range(3 * bodies):
        y[i] = y[i] + h * y[velocity_at(bodies) + i]
    turn_round(model.several, bodies, rigid, model.round_body, h, y)
    turn_general(model.several, bodies, rigid, model.general_body, model.inertia,
                 model.inverse_inertia, implicit, h, y)


@formula
def kick_round(several, bodies, rigid, round_body, inverse_inertia, h, forces, y):
    """Change the angular velocities of the bodies with a scalar inertia."""
    if round_body is not None:
        for k in range(chosen(several, round_body)):
            w = omega_at(bodies, rigid) + 3 * member(several, round_body, k)
            accumulate(y, w, scale(h * inverse_inertia[k], at(forces, w)))


@formula
def kick_general(several, bodies, rigid, general_body, inverse_inertia, h, forces, y):
    """Change the angular velocities of the bodies with an inertia matrix."""
    if general_body is not None:
        for k in range(chosen(several, general_body)):
            i = member(several, general_body, k)
            w = omega_at(bodies, rigid) + 3 * i
            q = quaternion(y, quaternion_at(bodies) + 4 * i)
            accumulate(y, w, scale(h, in_world(matrix_at(inverse_inertia, k), q, at(forces, w))))


@formula
def kick(model, bodies, rigid, h, forces, y):
    """Change all velocities by forces and moments that act for a time h."""
    for i in range(bodies):
        v = velocity_at(bodies) + 3 * i
        accumulate(y, v, scale(h * model.inverse_mass[i], at(forces, v)))
    kick_round(model.several, bodies, rigid, model.round_body, model.inverse_round_inertia, h,
               forces, y)
    kick_general(model.several, bodies, rigid, model.general_body, model.inverse_inertia, h,
                 forces, y)


@kernel
def advance(model, drive, t_ns, h_ns, steps, state, memory):
    """Take a number of steps of one length; see Method for the arguments."""
    bodies, rigid = counts(model)
    size = moving_size(drive.works, bodies, rigid)
    y = number_row(model.several, memory, 0, size)
    forces = number_row(model.several, memory, 1, size)
    middle = number_row(model.several, memory, 2, size)
    load(size, state, y)
    h = h_ns * 1e-9
    removed = 0.0
    for n in range(steps):
        now = (t_ns + n * h_ns) * 1e-9 + 0.5 * h
        drift(model, bodies, rigid, False, 0.5 * h, y)
        apply_forces(model, drive, now, y, forces)
        for i in range(size):
            middle[i] = y[i]
        kick(model, bodies, rigid, 0.5 * h, forces, middle)
        apply_forces(model, drive, now, middle, forces)
        kick(model, bodies, rigid, h, forces, y)
        for i in range(work_at(bodies, rigid), size):
            y[i] = y[i] + h * forces[i]
        drift(model, bodies, rigid, True, 0.5 * h, y)
        removed += normalise(bodies, rigid, y)
    store(size, y, state)
    return removed
