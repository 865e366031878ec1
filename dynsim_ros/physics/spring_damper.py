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
def length_and_inverse_square(r, epsilon):
    """
    Return L = |r| [m] and 1 / L^2, finite at L = 0: it is 1 / (L^2 + epsilon^2).

    r: (3,) position of Q from P in world [m]; epsilon [m]: that of the model changes no bit unless
    L is below a millionth of the spring's own lengths. The division need not wait for the root.
    """
    square = dot(r, r)
    return root(square), 1.0 / (square + epsilon * epsilon)


@formula
def length_and_direction(r, epsilon):
    """Return L = |r| [m] and the unit vector u to Q from P, zero at L = 0; arguments as above."""
    length, inverse_square = length_and_inverse_square(r, epsilon)
    return length, scale(length * inverse_square, r)


@formula
def spring_tension(stiffness, extension):
    """Return -k (L - L_n), along u [N]; stiffness k [N/m], extension L - L_n [m]."""
    return -stiffness * extension


@formula
def spring_force(stiffness, length, natural_length, u):
    """Return -k (L - L_n) u; k [N/m], lengths [m], u: (3,) to Q from P."""
    return scale(spring_tension(stiffness, length - natural_length), u)


@formula
def length_rate(v, u):
    """Return dL/dt = v . u [m/s]; v: (3,) velocity of Q relative to P in world [m/s]."""
    return dot(v, u)


@formula
def damper_tension(damping, rate):
    """Return -b dL/dt, along u [N]; damping b [N s/m], rate dL/dt [m/s]."""
    return -damping * rate


@formula
def damper_force(damping, rate, u):
    """Return -b dL/dt u; arguments as above, u: (3,) to Q from P."""
    return scale(damper_tension(damping, rate), u)
