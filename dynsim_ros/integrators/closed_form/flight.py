# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Flight of a centre of mass: constant force, air resistance linear in the velocity, uniform wind.

Source: Landau and Lifshitz, Mechanics (1976), section 25 (friction linear in the velocity), as
means over the time flown: they stay exact where resistance is small or overwhelming.
"""

from .phi import decay_and_phis
from ...physics.jit import formula
from ...physics.vector import add, scale


@formula
def free_flight(t, position, velocity, acceleration):
    """Return position and velocity at time t; acceleration: (3,) constant or None [m/s^2]."""
    moved = add(position, scale(t, velocity))
    if acceleration is None:
        return moved, velocity
    return (add(moved, scale(0.5 * t * t, acceleration)),
            add(velocity, scale(t, acceleration)))


@formula
def flight(t, position, velocity, acceleration, mass, linear_drag, wind):
    """
    Return position and velocity at time t [s] from those at time 0, both (3,) in world.

    acceleration: (3,) by gravity and other constant forces [m/s^2], None without; mass [kg];
    linear_drag: b [N s/m], None without air; wind: (3,) velocity of the air [m/s], None if still.
    Exact for all b >= 0; t < 0 goes back in time as long as exp(-b t / m) is finite.
    """
    if linear_drag is None:
        return free_flight(t, position, velocity, acceleration)
    x = linear_drag * t / mass
    decay, first, second = decay_and_phis(x)
    moved = add(position, scale(t * first, velocity))
    after = scale(decay, velocity)
    if wind is not None:
        moved = add(moved, scale(t * (x * second), wind))
        after = add(after, scale(x * first, wind))
    if acceleration is not None:
        moved = add(moved, scale(t * (t * second), acceleration))
        after = add(after, scale(t * first, acceleration))
    return moved, after
