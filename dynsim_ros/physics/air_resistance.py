# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Air resistance, linear in the velocity relative to the air (sheet, 1.2)."""

from .jit import formula
from .vector import scale, subtract


@formula
def relative_velocity(velocity, air_velocity):
    """Return the (angular) velocity relative to the air's, which is None where it is still."""
    if air_velocity is not None:
        return subtract(velocity, air_velocity)
    return velocity


@formula
def air_force(linear_drag, velocity, air_velocity):
    """
    Return -b_air,1 (v - v_air): (3,) [N].

    linear_drag: [N s/m]; velocities: (3,) in world [m/s]; that of still air is None.
    """
    return scale(-linear_drag, relative_velocity(velocity, air_velocity))


@formula
def air_torque(rotational_drag, angular_velocity, air_angular_velocity):
    """
    Return -b_air,2 (omega - omega_air): (3,) [N m].

    rotational_drag: [N m s/rad]; angular velocities: (3,) in world [rad/s]; None as above.
    """
    return scale(-rotational_drag, relative_velocity(angular_velocity, air_angular_velocity))
