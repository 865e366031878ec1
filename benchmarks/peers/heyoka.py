# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
heyoka: Taylor's method of high order, compiled by LLVM for the scene.

The tolerance is fixed when the integrator is made; it chooses the order, and of the tolerances
that choose the same one only the first is measured.
"""

from functools import partial
import math

from algebra import Numbers
from equations import rates
import numpy as np
from states import in_world, Places, start

from . import fastest, installed, INSTANCES, Run, Setting, tolerances


def available():
    return installed('heyoka')[1]


def supports(case):
    return None


def settings(case):
    orders = {}
    for tolerance in tolerances(-1, -19):
        orders.setdefault(math.ceil(1 - 0.5 * math.log(tolerance)), tolerance)
    return [Setting('taylor', tolerance) for tolerance in orders.values()]


def prepare(case, setting):
    return end_run(system(case.scene), start(case.scene), case.duration, setting.value,
                   partial(in_world, case.scene))


def end_run(equations, y0, duration, tolerance, state_of):
    """Return the Run of a system to its end; state_of(y) turns its state into the usual one."""
    def run_of(taylor):
        state = taylor.state

        def run():
            taylor.time = 0.0
            state[:] = y0
            taylor.propagate_until(duration)
            return state
        return run

    run = fastest([run_of(integrator(equations, y0, tolerance)) for _ in range(INSTANCES)])
    return Run(run, lambda result: state_of(result.copy()))


def prepare_samples(case, setting, times):
    equations, y0, times = system(case.scene), start(case.scene), list(times)

    def run_of(taylor):
        state = taylor.state

        def run():
            taylor.time = 0.0
            state[:] = y0
            return taylor.propagate_grid(times)[-1]
        return run

    return Run(fastest([run_of(integrator(equations, y0, setting.value))
                        for _ in range(INSTANCES)]),
               partial(in_world, case.scene))


def system(scene):
    """Return the equations in heyoka's symbols."""
    import heyoka

    y = heyoka.make_vars(*(f'y{i}' for i in range(Places(scene).size)))
    numbers = Numbers(heyoka.expression, lambda a: a ** -0.5)
    return list(zip(y, rates(scene, numbers, heyoka.time, y)))


def integrator(equations, y0, tolerance):
    import heyoka

    # fast_math gains up to a quarter of the time and costs no accuracy that could be seen; the
    # other switches (compact_mode, slp_vectorize, force_avx512) were slower or made no difference.
    return heyoka.taylor_adaptive(equations, np.array(y0), tol=tolerance, fast_math=True)
