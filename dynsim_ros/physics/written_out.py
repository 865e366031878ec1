# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Loops over the numbers of a state, written out where LLVM would leave a loop.

What a loop goes through has to lie in memory, and is loaded and stored at each substep. Without
loops the compiler knows every number by name, and keeps in registers what it needs next: chains
of two and three bodies take a ninth to a fifth less time.
"""

from contextlib import contextmanager

from llvmlite.binding import set_option

# How large a loop may become, in units of LLVM; its own bound at numba's level of optimisation.
_OURS, _USUAL = 1000, 300


@contextmanager
def loops_written_out():
    """
    Let LLVM write larger loops out meanwhile.

    The bound is one of the whole process: for use under numba's lock, see lighter_compiling.
    """
    _set_threshold(_OURS)
    try:
        yield
    finally:
        _set_threshold(_USUAL)


def _set_threshold(threshold):
    set_option('dynsim_ros', f'-unroll-threshold={threshold}')
