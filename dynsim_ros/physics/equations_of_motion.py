# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Newton's second law and Euler's equation, solved for the accelerations (sheet, 3)."""

from .jit import formula
from .vector import cross, scale, subtract, transform, transform_back


@formula
def linear_acceleration(force, inverse_mass):
    """Return a = F / m of the centre of mass: (3,) in world [m/s^2] (Newton)."""
    return scale(inverse_mass, force)


@formula
def scalar_angular_acceleration(moment, inverse_inertia):
    """Return alpha = M / I where I is the same about every axis: (3,) in world [rad/s^2]."""
    return scale(inverse_inertia, moment)


@formula
def angular_acceleration(moment, inertia, inverse_inertia, rotation, angular_velocity):
    """
    Return alpha from M = I alpha + omega x (I omega): (3,) in world [rad/s^2] (Euler).

    moment: (3,) about the centre of mass in world [N m]; inertia and its inverse: three rows in
    body axes; rotation: body to world, three rows; angular_velocity: (3,) in world [rad/s].
    """
    omega = transform_back(rotation, angular_velocity)
    gyroscopic = cross(omega, transform(inertia, omega))
    alpha = transform(inverse_inertia, subtract(transform_back(rotation, moment), gyroscopic))
    return transform(rotation, alpha)


@formula
def moment_of_force(arm, force):
    """Return arm x F, about the centre of mass, of a force at Q: (3,) in world [N m]."""
    return cross(arm, force)
