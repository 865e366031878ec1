# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
A particle on springs of natural length zero: its motion is linear.

Springs k_i to anchors at c_i pull as one spring of stiffness K = sum of k_i to the centre
sum of k_i c_i / K, so that each component is a damped oscillator of its own. Gravity, a wind that
blows, drag, and anchors that move uniformly are linear as well; a damper along a spring is not.

Elsewhere in this package the direction of a spring is r / (L + epsilon); with natural length zero
epsilon is 2^-64 m, and nothing is moved by more than that.

Source: Landau and Lifshitz, Mechanics (1976), sections 25 and 26.
"""

from .oscillator import oscillation, responses
from ...physics.jit import formula
from ...physics.two_sum import quotient_in_two
from ...physics.vector import add, scale, subtract


def centre_of_springs(stiffnesses, anchors):
    """
    Return the stiffness [N/m] of several springs as one, and where that is held.

    stiffnesses: n numbers > 0 in all [N/m]; anchors: n tuples (3,), positions [m] or velocities
    [m/s]. Returns their mean (3,), weighted by stiffness.
    """
    # Added up one by one: what sum() does with the rounding depends on the Python.
    total, centre = 0.0, (0.0, 0.0, 0.0)
    for stiffness in stiffnesses:
        total += stiffness
    for stiffness, anchor in zip(stiffnesses, anchors):
        centre = add(centre, scale(stiffness / total, anchor))
    return total, centre


@formula
def on_centred_springs(t, position, velocity, mass, stiffness, centre, centre_velocity,
                       acceleration, linear_drag, wind, t_left=0.0):
    """
    Return position and velocity at time t + t_left >= 0 [s] from those at time 0, (3,) in world.

    mass [kg]; stiffness, centre, centre_velocity: from centre_of_springs, centre at time 0,
    centre_velocity None if the anchors rest; acceleration: (3,) by gravity and other constant
    forces [m/s^2] or None; linear_drag: b [N s/m] or None; wind: (3,) velocity of the air [m/s]
    or None. Rounding is that of the largest of the terms: also of how far the centre has moved.
    """
    a = (0.0, 0.0, 0.0) if acceleration is None else acceleration
    # in the frame of the centre
    y, v, air = subtract(position, centre), velocity, (0.0, 0.0, 0.0)
    if wind is not None:
        air = wind
    if centre_velocity is not None:
        v, air = subtract(v, centre_velocity), subtract(air, centre_velocity)
    g = 0.0
    if linear_drag is not None:
        g = 0.5 * linear_drag / mass
        a = add(a, scale(2.0 * g, air))
    square, left = quotient_in_two(stiffness, mass)
    c, s, slope, p = responses(t, g, square, t_left, left)
    x0, v0 = oscillation(y[0], v[0], a[0], square, c, s, slope, p)
    x1, v1 = oscillation(y[1], v[1], a[1], square, c, s, slope, p)
    x2, v2 = oscillation(y[2], v[2], a[2], square, c, s, slope, p)
    moved, after = add(centre, (x0, x1, x2)), (v0, v1, v2)
    if centre_velocity is not None:
        moved, after = add(moved, scale(t, centre_velocity)), add(after, centre_velocity)
    return moved, after
