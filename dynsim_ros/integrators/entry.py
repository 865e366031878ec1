# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Calling a kernel many times with arguments of the same types."""

import numba

from ..physics.lighter_compiling import lighter_compiling
from ..physics.written_out import loops_written_out


def entry(kernel, *arguments):
    """
    Return the kernel compiled for the types of some arguments, to be called with such ones only.

    Finding out the types of a Model at every call takes numba longer than a short run takes.
    """
    if numba.config.DISABLE_JIT:
        return kernel
    signature = tuple(numba.typeof(argument) for argument in arguments)
    # Asked first: compile() waits until no other thread compiles anything.
    if signature not in kernel.overloads:
        with lighter_compiling(), loops_written_out():
            kernel.compile(signature)
    return kernel.overloads[signature].entry_point
