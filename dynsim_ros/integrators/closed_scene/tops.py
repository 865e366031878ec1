# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The constants of a free rotation laid flat, so that those of many bodies fit in an array."""

from ..closed_form import TorqueFree
from ..closed_form.jacobi import Jacobi
from ...physics.jit import formula

# The numbers in a TorqueFree.
TOP_SIZE = 40


def laid_flat(motion):
    """Return the numbers of a TorqueFree, those of its parts in their places: TOP_SIZE floats."""
    numbers = []
    for part in motion:
        numbers += laid_flat(part) if isinstance(part, tuple) else [float(part)]
    return numbers


@formula
def top_from(n):
    """Return the TorqueFree that was laid flat; n: (TOP_SIZE,)."""
    functions = Jacobi(n[0] > 0.0, n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8],
                       (n[9], n[10], n[11], n[12]), (n[13], n[14], n[15], n[16]), n[17], n[18])
    return TorqueFree(functions, n[19], n[20], n[21], n[22], n[23], n[24], n[25],
                      (n[26], n[27], n[28]), (n[29], n[30], n[31]),
                      (n[32], n[33], n[34], n[35]), (n[36], n[37], n[38], n[39]))
