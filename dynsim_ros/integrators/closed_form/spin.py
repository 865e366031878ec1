# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Rotation of a body whose inertia is the same about every axis, with or without air.

Without air the angular velocity stays as it is; with air it decays to that of the air. Both keep
the axis of rotation if the air does not whirl, or whirls about that axis: then the orientation
turns about a fixed axis by the integral of the angular velocity. Else (keeps_axis is False) the
angular velocity below is still exact, but the orientation does not follow from its integral. A
constant moment acts as a whirl does.

Source: Euler's equation for a scalar inertia (sheet, 3.2), solved as in flight.py; finite turns:
Goldstein, Poole and Safko, Classical Mechanics (2002), section 4.7.
"""

from .flight import flight, free_flight
from .phase import angle_in_two, cosine_and_sine, norm_in_two
from ...physics.jit import formula
from ...physics.rotation import axis_angle_quaternion, quaternion_product
from ...physics.vector import add, cross, norm, scale, subtract

_EPS = 2.0 ** -52


@formula
def keeps_axis(angular_velocity, whirl):
    """Return whether spin_down holds: both (3,) in world [rad/s], parallel to rounding or zero."""
    size = norm(angular_velocity) * norm(whirl)
    return norm(cross(angular_velocity, whirl)) <= 4.0 * _EPS * size


@formula
def free_spin(t, orientation, angular_velocity, t_left=0.0):
    """Return orientation (w, x, y, z) and angular velocity (3,) at time t + t_left [s]."""
    rate, left = norm_in_two(angular_velocity)
    c, s = cosine_and_sine(*angle_in_two(0.5 * rate, 0.5 * left, t, t_left))
    if rate > 0.0:
        s /= rate
    x, y, z = angular_velocity
    return quaternion_product((c, s * x, s * y, s * z), orientation), angular_velocity


@formula
def spin_up(t, orientation, angular_velocity, acceleration):
    """
    Return orientation, angular velocity and turn under a constant moment about the axis.

    acceleration: (3,) by the moment, in world [rad/s^2]; else as spin_down.
    """
    turn, after = free_flight(t, (0.0, 0.0, 0.0), angular_velocity, acceleration)
    return quaternion_product(axis_angle_quaternion(turn), orientation), after, turn


@formula
def turn_and_spin(t, angular_velocity, inertia, rotational_drag, whirl, acceleration):
    """
    Return the integral of the angular velocity [rad] and that at time t, about any axes.

    Arguments as for spin_down. Both are as position and velocity in flight.
    """
    return flight(t, (0.0, 0.0, 0.0), angular_velocity, acceleration, inertia, rotational_drag,
                  whirl)


@formula
def spin_down(t, orientation, angular_velocity, inertia, rotational_drag, whirl, acceleration,
              t_left=0.0):
    """
    Return orientation (w, x, y, z), angular velocity (3,) and turn, in world at time t + t_left.

    The turn is the integral of the angular velocity [rad]. inertia: about the axis [kg m^2];
    rotational_drag: b [N m s/rad]; whirl: (3,) angular velocity of the air in world [rad/s];
    acceleration: (3,) by a constant moment [rad/s^2]. Only where all keep the axis: keeps_axis.
    """
    # The air may carry the body round many times: the phase of that keeps all digits.
    if rotational_drag * t > inertia:
        slip = subtract(angular_velocity, whirl)
        turn, after = turn_and_spin(t, slip, inertia, rotational_drag, (0.0, 0.0, 0.0),
                                    acceleration)
        carried, _ = free_spin(t, orientation, whirl, t_left)
        return (quaternion_product(axis_angle_quaternion(turn), carried), add(after, whirl),
                add(turn, scale(t, whirl)))
    turn, after = turn_and_spin(t, angular_velocity, inertia, rotational_drag, whirl, acceleration)
    return quaternion_product(axis_angle_quaternion(turn), orientation), after, turn
