# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Rest: velocities that are zero, and forces that cancel but for rounding.

The sum of n terms, each the result of a few operations, is uncertain by some units in the last
place of their sizes: a smaller sum says nothing about the motion, not even its direction. A body
is held at rest if the sum is at most 8 * 2^-52 of the sum of the sizes. In a stable equilibrium
with stiffness k that leaves out a swing by (sum / k), which is rounding of the positions. An
unstable one is left by such a sum, in time: there ask for a sum of exactly zero.
"""

from ...physics.jit import formula
from ...physics.vector import norm

# In units of the sizes of the terms.
THRESHOLD = 8.0 * 2.0 ** -52


@formula
def spring_size(stiffness, natural_length, r_p, r_q):
    """
    Return the size of the terms of a spring's force, for cancels [N].

    The length comes from the positions of the ends, (3,) in world [m]: their rounding counts,
    which for a stiff spring is far more than that of the force.
    """
    return stiffness * (norm(r_p) + norm(r_q) + natural_length)


@formula
def cancels(total, size):
    """
    Return whether a sum is zero to rounding.

    total: (3,) sum of forces [N] (or moments, or accelerations); size: sum of the sizes of its
    terms, in the same unit.
    """
    return norm(total) <= THRESHOLD * size
