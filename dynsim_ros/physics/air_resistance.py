# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Air resistance, linear in the velocity relative to the air (sheet, 1.2)."""

from .jit import formula
from .vector import scale, subtract


@formula
def air_force(linear_drag, velocity, air_velocity):
    """Return -b_air,1 (v - v_air): (3,) [N]; drag [N s/m], velocities (3,) in world [m/s]."""
    return scale(-linear_drag, subtract(velocity, air_velocity))


@formula
def air_torque(rotational_drag, angular_velocity, air_angular_velocity):
    """Return -b_air,2 (omega - omega_air): (3,) [N m]; drag [N m s/rad], (3,) in world [rad/s]."""
    return scale(-rotational_drag, subtract(angular_velocity, air_angular_velocity))
