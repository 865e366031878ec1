# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""dynsim_ros itself, through Propagator, with every method that it has."""

from functools import partial

import dynsim_ros
from dynsim_ros.simulation import Propagator
from states import Places

from . import fastest, INSTANCES, Run, Setting, steps, tolerances

ADAPTIVE = ('auto', 'extrapolation', 'dop853', 'stiff', 'radau')
FIXED_STEP = ('rk4', 'leapfrog', 'semi_implicit_euler', 'linearly_implicit_euler',
              'explicit_euler', 'explicit_euler_axis_angle')


def available():
    return dynsim_ros.__version__


def supports(case):
    return None


def settings(case):
    return ([Setting(method, tolerance) for method in ADAPTIVE
             for tolerance in tolerances(-1, -14)]
            + [Setting(method, step) for method in FIXED_STEP
               for step in steps(case.duration, 0.1, 1e-6)])


def prepare(case, setting):
    duration, size = case.duration, Places(case.scene).size
    return Run(fastest([partial(each.end_state, duration) for each in propagators(case, setting)]),
               lambda result: result[:size])


def prepare_samples(case, setting, times):
    duration, size = case.duration, Places(case.scene).size
    rate = (len(times) - 1) / duration
    return Run(fastest([partial(each.samples, duration, rate)
                        for each in propagators(case, setting)]),
               lambda result: result[:, :size])


def propagators(case, setting):
    """Return equal Propagators: one where the run is long, and where it lies matters less."""
    count = 1 if setting.method in FIXED_STEP else INSTANCES
    return [propagator(case, setting) for _ in range(count)]


def propagator(case, setting):
    if setting.method in FIXED_STEP:
        return Propagator(case.scene, integrator=setting.method, step=setting.value)
    return Propagator(case.scene, integrator=setting.method, tolerance=setting.value)
