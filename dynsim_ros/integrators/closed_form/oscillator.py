# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The damped harmonic oscillator under a constant force: y'' + 2 g y' + w^2 y = a; g, w >= 0.

By its responses: C to a displacement, C(0) = 1, S to a velocity, S'(0) = 1, and P to a constant
acceleration, P''(0) = 1, each from rest otherwise: y = y_0 C + v_0 S + a P. They are free of
cancellation whether the motion swings, creeps or is critically damped, and where spring or
resistance are arbitrarily weak; g = w = 0 is motion with constant acceleration.

Source: Landau and Lifshitz, Mechanics (1976), sections 25 and 26.
"""

import math

from .phase import angle_in_two, cosine_and_sine, root_in_two
from .phi import phi_1
from ...physics.elementary import exponential
from ...physics.jit import formula
from ...physics.two_sum import two_product, two_sum

_TERMS = 26


@formula
def series_of_p(x, y):
    """
    Return P / t^2 by its power series in t; x: 2 g t <= 2, y: (w t)^2 <= 1.

    Each coefficient follows from two before it, by the differential equation.
    """
    before, last = 0.0, 0.5
    total = 0.5
    for n in range(3, _TERMS):
        before, last = last, -(x * last + y * before / (n - 1)) / n
        total += last
    return total


@formula
def swinging(t, g, square, t_left, square_left):
    """Return C, S, S' and P at time t + t_left where w > g; square + square_left: w^2."""
    damped, damped_left = two_product(g, g)
    difference, left = two_sum(square, -damped)
    difference, left = two_sum(difference, left + (square_left - damped_left))
    frequency, left = root_in_two(difference, left)
    angle, left = angle_in_two(frequency, left, t, t_left)
    cosine, sine = cosine_and_sine(angle, left)
    decay, _ = exponential(-g * t)
    s = decay * t
    if angle != 0.0:
        s *= sine / angle
    cosine *= decay
    c = cosine + g * s
    y = square * t * t
    p = t * (t * series_of_p(2.0 * g * t, y)) if y < 1.0 else (1.0 - c) / square
    return c, s, cosine - g * s, p


@formula
def creeping(t, g, square):
    """Return C, S, S' and P at time t where w <= g; square: w^2."""
    root = math.sqrt(g * g - square)
    # the two roots are -fast_rate and -slow_rate
    fast_rate, slow_rate = g + root, 0.0
    if square > 0.0:
        slow_rate = square / fast_rate
    fast, slow, gap = fast_rate * t, slow_rate * t, 2.0 * root * t
    faded, _ = exponential(-fast)
    slower, _ = exponential(-slow)
    s = t * slower * phi_1(gap)
    c = faded + fast_rate * s
    if slow > 0.5:
        p = (1.0 - c) / square
    elif gap > 1.0:
        p = t * (t * ((phi_1(slow) - phi_1(fast)) / gap))
    else:
        p = t * (t * series_of_p(2.0 * g * t, square * t * t))
    return c, s, faded - slow_rate * s, p


@formula
def responses(t, g, square, t_left=0.0, square_left=0.0):
    """
    Return C, S, S' and P at time t >= 0 [s]; g: [1/s], square: w^2 [1/s^2].

    t_left, square_left: what rounding has left out of t and square.
    """
    if square > g * g:
        return swinging(t, g, square, t_left, square_left)
    return creeping(t, g, square)


@formula
def oscillation(y, v, a, square, c, s, slope, p):
    """Return y and y' after the responses C, S, S' and P; y, v: at time 0."""
    return c * y + s * v + p * a, slope * v + s * (a - square * y)
