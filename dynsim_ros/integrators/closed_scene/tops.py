# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The constants of a free rotation laid flat, so that those of many bodies fit in an array."""

from ..closed_form import torque_free_in_full, TorqueFree
from ..closed_form.jacobi import Jacobi
from ...physics.jit import formula
from ...physics.motion import matrix_at
from ...physics.state import omega_at, put_quaternion, quaternion, quaternion_at
from ...physics.vector import at, put

# The numbers in a TorqueFree.
TOP_SIZE = 40


@formula
def lay_flat(motion, n):
    """Write the numbers of a TorqueFree, those of its parts in their places, to n: (TOP_SIZE,)."""
    functions = motion.jacobi
    n[0] = 1.0 if functions.hyperbolic else 0.0
    put(n, 1, (functions.complement, functions.landen, functions.inner))
    put(n, 4, (functions.period, functions.inverse_period, functions.scale))
    put(n, 7, (functions.nome, functions.ratio, functions.even[0]))
    put_quaternion(n, 9, functions.even)
    put_quaternion(n, 13, functions.odd)
    put(n, 17, (functions.slope, functions.turn, motion.rate))
    put(n, 20, (motion.phase, motion.period, motion.period_left))
    put(n, 23, (motion.circulation, motion.precession, motion.precession_left))
    put(n, 26, motion.direction)
    put(n, 29, motion.omega)
    put_quaternion(n, 32, motion.body)
    put_quaternion(n, 36, motion.world)


@formula
def top_from(n):
    """Return the TorqueFree that was laid flat; n: (TOP_SIZE,)."""
    functions = Jacobi(n[0] > 0.0, n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8],
                       (n[9], n[10], n[11], n[12]), (n[13], n[14], n[15], n[16]), n[17], n[18])
    return TorqueFree(functions, n[19], n[20], n[21], n[22], n[23], n[24], n[25],
                      (n[26], n[27], n[28]), (n[29], n[30], n[31]),
                      (n[32], n[33], n[34], n[35]), (n[36], n[37], n[38], n[39]))


@formula
def find_constants(tops, bodies, rigid, start):
    """Write the constants of all Tops, from the state at the start, unless they are there."""
    if tops.known[0]:
        return
    for k in range(tops.body.shape[0]):
        i = tops.body[k]
        lay_flat(torque_free_in_full(
            at(tops.moments[k], 0), matrix_at(tops.axes, k),
            quaternion(start, quaternion_at(bodies) + 4 * i),
            at(start, omega_at(bodies, rigid) + 3 * i)), tops.constants[k])
    tops.known[0] = True
