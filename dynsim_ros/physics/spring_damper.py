# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Translational spring-damper between the points P and Q (sheet, 1.1).

All forces act on Q from P, in world [N]; those on P are their opposites.
"""

from .jit import formula
from .lanes import root
from .vector import dot, scale


@formula
def length_and_direction(r, epsilon):
    """
    Return L = |r| [m] and the unit vector u to Q from P.

    r: (3,) position of Q from P in world [m]; epsilon: [m] keeps u finite (zero) at L = 0: u is
    r L / (L^2 + epsilon^2). The model's epsilon changes no bit of u unless L is below a millionth
    of the spring's own lengths. The division need not wait for the root.
    """
    square = dot(r, r)
    length = root(square)
    return length, scale(length * (1.0 / (square + epsilon * epsilon)), r)


@formula
def spring_force(stiffness, length, natural_length, u):
    """Return -k (L - L_n) u; stiffness k [N/m], lengths [m], u: (3,) to Q from P."""
    return scale(-stiffness * (length - natural_length), u)


@formula
def length_rate(v, u):
    """Return dL/dt = v . u [m/s]; v: (3,) velocity of Q relative to P in world [m/s]."""
    return dot(v, u)


@formula
def damper_force(damping, rate, u):
    """Return -b dL/dt u; damping b [N s/m], rate dL/dt [m/s], u: (3,) to Q from P."""
    return scale(-damping * rate, u)
