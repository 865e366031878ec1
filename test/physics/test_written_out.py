# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Loops as long as a state are written out in kernels, and not in what else numba compiles."""

from dynsim_ros.integrators.entry import entry
from dynsim_ros.physics.written_out import loops_written_out
import numba
import numpy as np
import pytest


def newly_made():
    """Return a function with a loop over the numbers of four bodies."""
    @numba.njit(_nrt=False)
    def advance(y, rate, step):
        for i in range(52):
            y[i] = (y[i] + step * rate[i]) * (1.0 - step * step * y[i])
        return y[0]
    return advance


def has_loop(compiled):
    """Return whether there is a phi, or a branch, in the code that LLVM has made of a function."""
    (text,) = compiled.inspect_llvm().values()
    (body,) = [part for part in text.split('define ')[1:] if 'newly_made' in part.split('(')[0]
               and 'cpython' not in part.split('(')[0] and 'cfunc' not in part.split('(')[0]]
    return ' phi ' in body or 'br i1' in body


def compiled_by_numba():
    advance = newly_made()
    advance(np.ones(52), np.ones(52), 0.1)
    return advance


def test_they_are_in_a_kernel():
    advance, y = newly_made(), np.linspace(0.0, 1.0, 52)
    before = y.copy()
    run = entry(advance, y, np.ones(52), 0.5)
    run(y, np.ones(52), 0.5)
    assert np.allclose(y, (before + 0.5) * (1.0 - 0.25 * before), rtol=1e-15)
    assert not has_loop(advance)


def test_they_are_not_in_other_functions():
    assert has_loop(compiled_by_numba())
    with pytest.raises(KeyError), loops_written_out():
        raise KeyError
    assert has_loop(compiled_by_numba())
