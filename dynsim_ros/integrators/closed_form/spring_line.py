# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
A particle that moves along the line of its only spring, to an anchor that rests or moves along it.

The length obeys m L'' = -k (L - L_n) - b_spring L' - b_air (L' - wind) + force: it is that of a
damped oscillator as long as it is above zero, which least_length tells; above a thousandth of
L_n, epsilon changes no bit of u = r / (L + epsilon) either. The motion stays on the line if
is_along is True for acceleration, for wind, and for the velocity of the particle against the
anchor. To be so but for rounding does not do: across the line the motion may be unstable.

Source: the formula sheet, 1.1; for the times at which L turns round, Landau and Lifshitz,
Mechanics (1976), section 25, equations 25.4 and 25.6, set to zero after differentiation.
"""

import math
from typing import NamedTuple

from .oscillator import oscillation, responses
from ...physics.elementary import arc_tangent, area_tangent
from ...physics.jit import formula
from ...physics.two_sum import quotient_in_two
from ...physics.vector import add, dot, norm, scale, subtract


class SpringLine(NamedTuple):
    """
    A motion along a spring: L'' + 2 resistance L' + square (L - natural_length) = push.

    length [m] and rate [m/s]: L and L' at time 0; square_left: what rounding left out of square;
    direction: (3,) unit vector to the particle; anchor: (3,) at time 0 [m]; anchor_velocity: (3,)
    [m/s].
    """

    length: float
    rate: float
    natural_length: float
    resistance: float
    square: float
    square_left: float
    push: float
    direction: tuple
    anchor: tuple
    anchor_velocity: tuple


@formula
def is_along(direction, vector):
    """Return whether a vector has no part across a direction, to the last bit; both (3,)."""
    u, v = direction, vector
    # The fused cross product of parallel vectors is what rounding leaves, not always zero.
    return u[1] * v[2] == u[2] * v[1] and u[2] * v[0] == u[0] * v[2] and u[0] * v[1] == u[1] * v[0]


@formula
def spring_line(position, velocity, anchor, anchor_velocity, mass, stiffness, natural_length,
                damping, acceleration, linear_drag, wind):
    """
    Return the SpringLine of a particle; vectors (3,) in world at time 0.

    The particle is not at the anchor. mass [kg]; stiffness k [N/m]; natural_length [m]; None if
    absent: damping b of the damper [N s/m], acceleration by gravity and other constant forces
    [m/s^2], linear_drag b of the air [N s/m] and wind, the velocity of the air [m/s].
    """
    r = subtract(position, anchor)
    length = norm(r)
    u = scale(1.0 / length, r)
    damper = 0.0 if damping is None else damping
    drag = 0.0 if linear_drag is None else linear_drag
    air = (0.0, 0.0, 0.0) if wind is None else wind
    push = drag / mass * dot(subtract(air, anchor_velocity), u)
    if acceleration is not None:
        push += dot(acceleration, u)
    square, left = quotient_in_two(stiffness, mass)
    return SpringLine(length, dot(subtract(velocity, anchor_velocity), u), natural_length,
                      0.5 * (damper + drag) / mass, square, left, push, u, anchor,
                      anchor_velocity)


@formula
def length_along_spring(line, t, t_left=0.0):
    """Return L [m] and L' [m/s] at time t + t_left >= 0 [s], as if L could pass zero."""
    c, s, slope, p = responses(t, line.resistance, line.square, t_left, line.square_left)
    y, rate = oscillation(line.length - line.natural_length, line.rate, line.push, line.square, c,
                          s, slope, p)
    return line.natural_length + y, rate


@formula
def along_spring(line, t, t_left=0.0):
    """Return position and velocity in world at time t + t_left >= 0 [s]; line: SpringLine."""
    length, rate = length_along_spring(line, t, t_left)
    return (add(add(line.anchor, scale(t, line.anchor_velocity)), scale(length, line.direction)),
            add(line.anchor_velocity, scale(rate, line.direction)))


@formula
def turning_times(line):
    """
    Return the first two times > 0 at which L' = 0; inf for those that do not come.

    Later ones are no extremes of L over all time: each swing is smaller than that before.
    """
    g, square, v = line.resistance, line.square, line.rate
    force = line.push - square * (line.length - line.natural_length)
    # L' = S' v + S force is zero where S' / S = -force / v.
    across = g * v - force
    if square > g * g:
        frequency = math.sqrt(square - g * g)
        angle = arc_tangent(frequency * v, across)
        if angle <= 0.0:
            angle += math.pi
        return angle / frequency, (angle + math.pi) / frequency
    root = math.sqrt(g * g - square)
    if v == 0.0 or across == 0.0:
        return math.inf, math.inf
    time, ratio = v / across, root * v / across
    if not (time > 0.0 and ratio < 1.0):
        return math.inf, math.inf
    return time * (area_tangent(ratio) / ratio if ratio > 0.0 else 1.0), math.inf


@formula
def last_length(line):
    """Return what L tends to, or the middle of an undamped swing."""
    if line.square > 0.0:
        return line.natural_length + line.push / line.square
    if line.push == 0.0 and line.resistance > 0.0:
        return line.length + 0.5 * line.rate / line.resistance
    # a spring without stiffness: L grows or falls for ever, or stays
    trend = line.push if line.push != 0.0 else line.rate
    return line.length if trend == 0.0 else math.copysign(math.inf, trend)


@formula
def least_length(line, t):
    """Return the smallest L in the time from 0 to t, which may be infinite; -inf if L falls on."""
    least = line.length
    for time in turning_times(line):
        if time < t:
            least = min(least, length_along_spring(line, time)[0])
    last = length_along_spring(line, t)[0] if t < math.inf else last_length(line)
    return min(least, last)
