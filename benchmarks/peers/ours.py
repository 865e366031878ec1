# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""dynsim_ros itself, through Propagator, with every method that it has."""

import dynsim_ros
from dynsim_ros.simulation import Propagator
from states import Places

from . import Run, Setting, steps, tolerances

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
    end_state, duration, size = (propagator(case, setting).end_state, case.duration,
                                 Places(case.scene).size)
    return Run(lambda: end_state(duration), lambda result: result[:size])


def prepare_samples(case, setting, times):
    samples, duration, size = (propagator(case, setting).samples, case.duration,
                               Places(case.scene).size)
    rate = (len(times) - 1) / duration
    return Run(lambda: samples(duration, rate), lambda result: result[:, :size])


def propagator(case, setting):
    if setting.method in FIXED_STEP:
        return Propagator(case.scene, integrator=setting.method, step=setting.value)
    return Propagator(case.scene, integrator=setting.method, tolerance=setting.value)
