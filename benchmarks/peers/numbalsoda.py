# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
numbalsoda: Hairer's DOP853 in Fortran and LSODA in C++, called without Python.

The right-hand side is compiled by numba for the scene, its numbers as constants.
"""

from functools import lru_cache

import numba
import numpy as np
from states import in_world, start
from symbols import python_function

from . import installed, Run, Setting, tolerances, Unavailable

# No run may take more steps than this.
MOST_STEPS = 2_000_000


def available():
    try:
        return installed('numbalsoda')[1]
    except Unavailable as error:
        raise Unavailable(f'{error}; pip builds it with cmake and gfortran') from None


def supports(case):
    return None


def settings(case):
    return [Setting(method, tolerance) for method in ('dop853', 'lsoda')
            for tolerance in tolerances(-1, -15 if method == 'dop853' else -13)]


def prepare(case, setting):
    return prepare_samples(case, setting, np.array([0.0, case.duration]), end=True)


def prepare_samples(case, setting, times, end=False):
    y0, times = start(case.scene), np.array(times)
    function, address = solver(setting.method), right_hand_side(case.scene).address
    tolerance = setting.value

    def run():
        return function(address, y0, times, tolerance)

    def state(result):
        states, success = result
        if not success:
            return None
        return in_world(case.scene, states[-1] if end else states)

    return Run(run, state)


@lru_cache
def right_hand_side(scene):
    import numbalsoda

    function = python_function(scene, 't, y, out, p')
    return numba.cfunc(numbalsoda.lsoda_sig, error_model='numpy', fastmath=True)(function)


@lru_cache
def solver(method):
    """Return a compiled function that calls the solver with all its arguments in their places."""
    import numbalsoda

    solve, most = getattr(numbalsoda, method), MOST_STEPS

    @numba.njit
    def function(address, y0, times, tolerance):
        return solve(address, y0, times, rtol=tolerance, atol=tolerance, mxstep=most)

    return function
