# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Rotation of a body whose inertia is the same about every axis, with or without air.

Without air the angular velocity stays as it is; with air it decays to that of the air. Both keep
the axis of rotation if the air does not whirl, or whirls about that axis: then the orientation
turns about a fixed axis by the integral of the angular velocity. Else (keeps_axis is False) the
angular velocity below is still exact, but no orientation follows from it in closed form.

Source: Euler's equation for a scalar inertia (sheet, 3.2), solved as in flight.py; finite turns:
Goldstein, Poole and Safko, Classical Mechanics (2002), section 4.7.
"""

import math

from .phi import phi_1, phi_2
from ...physics.jit import formula
from ...physics.rotation import axis_angle_quaternion, quaternion_product
from ...physics.vector import add, cross, norm, scale

_EPS = 2.0 ** -52


@formula
def keeps_axis(angular_velocity, whirl):
    """Return whether spin_down holds: both (3,) in world [rad/s], parallel to rounding or zero."""
    size = norm(angular_velocity) * norm(whirl)
    return norm(cross(angular_velocity, whirl)) <= 4.0 * _EPS * size


@formula
def free_spin(t, orientation, angular_velocity):
    """Return orientation (w, x, y, z) and angular velocity (3,) in world at time t [s]."""
    turn = axis_angle_quaternion(scale(t, angular_velocity))
    return quaternion_product(turn, orientation), angular_velocity


@formula
def decayed_spin(t, angular_velocity, inertia, rotational_drag, whirl):
    """Return the angular velocity at time t [s]; arguments as for spin_down, any whirl."""
    x = rotational_drag * t / inertia
    after = scale(math.exp(-x), angular_velocity)
    if whirl is not None:
        after = add(after, scale(x * phi_1(x), whirl))
    return after


@formula
def spin_down(t, orientation, angular_velocity, inertia, rotational_drag, whirl):
    """
    Return orientation (w, x, y, z) and angular velocity (3,) in world at time t [s].

    inertia: about every axis [kg m^2]; rotational_drag: b [N m s/rad]; whirl: (3,) angular
    velocity of the air in world [rad/s], None if it does not whirl. Only where keeps_axis.
    """
    x = rotational_drag * t / inertia
    turn = scale(t * phi_1(x), angular_velocity)
    if whirl is not None:
        turn = add(turn, scale(t * (x * phi_2(x)), whirl))
    after = decayed_spin(t, angular_velocity, inertia, rotational_drag, whirl)
    return quaternion_product(axis_angle_quaternion(turn), orientation), after
