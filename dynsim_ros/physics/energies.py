# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The loops over bodies and springs that add up energies."""

from numba import literal_unroll

from .energy import (gravitational_energy, rotational_energy, scalar_rotational_energy,
                     spring_energy, translational_energy)
from .forces import end_place
from .jit import formula, kernel
from .motion import matrix_at
from .rotation import rotation_matrix
from .spring_damper import length_and_direction
from .state import counts, omega_at, quaternion, quaternion_at, velocity_at
from .vector import at, subtract


@formula
def group_energy(several, bodies, rigid, p, q, stiffness, natural_length, epsilon, anchors, t, y):
    """Return the energy stored in one SpringGroup [J]."""
    total = 0.0
    for s in range(stiffness.shape[0]):
        r_p, _ = end_place(several, bodies, p.anchor, p.particle, p.body, p.offset, s, anchors,
                           True, t, y)
        r_q, _ = end_place(several, bodies, q.anchor, q.particle, q.body, q.offset, s, anchors,
                           True, t, y)
        length, _ = length_and_direction(subtract(r_q, r_p), epsilon[s])
        total += spring_energy(stiffness[s], length, natural_length[s])
    return total


@formula
def springs_energy(several, bodies, rigid, springs, anchors, t, y):
    """Return the energy stored in all springs [J]."""
    total = 0.0
    if springs is not None:
        for group in literal_unroll(springs):
            total += group_energy(several, bodies, rigid, group.p, group.q, group.stiffness,
                                  group.natural_length, group.epsilon, anchors, t, y)
    return total


@formula
def round_energies(bodies, rigid, round_body, round_inertia, y):
    """Return the kinetic energy of the rotations of bodies with a scalar inertia [J]."""
    total = 0.0
    if round_body is not None:
        for i in range(round_body.shape[0]):
            omega = at(y, omega_at(bodies, rigid) + 3 * round_body[i])
            total += scalar_rotational_energy(round_inertia[i], omega)
    return total


@formula
def general_energies(bodies, rigid, general_body, inertia, y):
    """Return the kinetic energy of the rotations of bodies with an inertia matrix [J]."""
    total = 0.0
    if general_body is not None:
        for i in range(general_body.shape[0]):
            rotation = rotation_matrix(quaternion(y, quaternion_at(bodies) + 4 * general_body[i]))
            omega = at(y, omega_at(bodies, rigid) + 3 * general_body[i])
            total += rotational_energy(matrix_at(inertia, i), rotation, omega)
    return total


@formula
def gravity_energies(bodies, weight, y):
    """Return the gravitational energy of all bodies [J]."""
    total = 0.0
    if weight is not None:
        for i in range(bodies):
            total += gravitational_energy(at(weight[i], 0), at(y, 3 * i))
    return total


@kernel
def energies(model, anchors, t, y):
    """Return (kinetic, gravitational, spring) energy [J] of a state."""
    bodies, rigid = counts(model)
    kinetic = (round_energies(bodies, rigid, model.round_body, model.round_inertia, y)
               + general_energies(bodies, rigid, model.general_body, model.inertia, y))
    for i in range(bodies):
        kinetic += translational_energy(model.mass[i], at(y, velocity_at(bodies) + 3 * i))
    return (kinetic, gravity_energies(bodies, model.weight, y),
            springs_energy(model.several, bodies, rigid, model.springs, anchors, t, y))
