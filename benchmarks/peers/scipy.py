# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
scipy: DOP853 and LSODA, their right-hand side compiled by numba for the scene.

solve_ivp has both; ode('dop853') and odeint are older, and quicker, ways to the same methods.
"""

from functools import lru_cache, partial

import numba
import numpy as np
from states import in_world, start
from symbols import python_function

from . import installed, Run, Setting, tolerances

MOST_STEPS = 10_000_000


def available():
    return installed('scipy')[1]


def supports(case):
    return None


def settings(case):
    return [Setting(method, tolerance)
            for method in ('odeint', 'ode dop853', 'solve_ivp DOP853', 'solve_ivp LSODA')
            for tolerance in tolerances(-1, -14 if 'dop853' in method.lower() else -12)]


def prepare(case, setting):
    from scipy import integrate

    rates, y0, tolerance = right_hand_side(case.scene), start(case.scene), setting.value
    duration = case.duration

    def by_odeint():
        return integrate.odeint(rates, y0, (0.0, duration), tfirst=True, rtol=tolerance,
                                atol=tolerance, mxstep=MOST_STEPS)[-1]

    def by_ode():
        solver = integrate.ode(rates).set_integrator('dop853', rtol=tolerance, atol=tolerance,
                                                     nsteps=MOST_STEPS)
        return solver.set_initial_value(y0).integrate(duration)

    def by_solve_ivp():
        return integrate.solve_ivp(rates, (0.0, duration), y0, setting.method.split()[1],
                                   t_eval=(duration,), rtol=tolerance, atol=tolerance).y[:, -1]

    runs = {'odeint': by_odeint, 'ode dop853': by_ode}
    return Run(runs.get(setting.method, by_solve_ivp),
               partial(in_world, case.scene))


@lru_cache
def right_hand_side(scene):
    """Return f(t, y), compiled."""
    write = numba.njit(error_model='numpy', fastmath=True)(python_function(scene, 't, y, out'))

    @numba.njit(numba.float64[::1](numba.float64, numba.float64[::1]))
    def rates(t, y):
        out = np.empty_like(y)
        write(t, y, out)
        return out

    return rates
