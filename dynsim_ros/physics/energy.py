# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Energies and power."""

from .jit import formula
from .vector import dot, transform, transform_back


@formula
def translational_energy(mass, velocity):
    """Return m v^2 / 2 [J]."""
    return 0.5 * mass * dot(velocity, velocity)


@formula
def scalar_rotational_energy(inertia, angular_velocity):
    """Return I omega^2 / 2 [J], for an inertia that is the same about every axis."""
    return 0.5 * inertia * dot(angular_velocity, angular_velocity)


@formula
def rotational_energy(inertia, rotation, angular_velocity):
    """Return omega . I omega / 2 [J]; inertia in body axes, rotation body to world, three rows."""
    omega = transform_back(rotation, angular_velocity)
    return 0.5 * dot(omega, transform(inertia, omega))


@formula
def gravitational_energy(weight, position):
    """Return -F_g . r [J], zero at the origin; weight: (3,) [N], position: (3,) in world [m]."""
    return -dot(weight, position)


@formula
def spring_energy(stiffness, length, natural_length):
    """Return k (L - L_n)^2 / 2 [J]."""
    stretch = length - natural_length
    return 0.5 * stiffness * stretch * stretch


@formula
def power(force, velocity):
    """Return F . v [W]; also of a torque and an angular velocity."""
    return dot(force, velocity)
