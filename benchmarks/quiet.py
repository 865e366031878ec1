# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Silence for libraries that write to the terminal from Fortran or C."""

import os
import sys


def silence_libraries():
    """
    Send what is written to the file descriptors 1 and 2 nowhere; print() goes on as before.

    For the rest of the process: Fortran keeps its lines and writes them at its end.
    """
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for name, descriptor in (('stdout', 1), ('stderr', 2)):
        getattr(sys, name).flush()
        own = os.fdopen(os.dup(descriptor), 'w', encoding='utf-8', buffering=1)
        setattr(sys, name, own)
        os.dup2(nowhere, descriptor)
    os.close(nowhere)
