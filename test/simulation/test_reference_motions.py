# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Every scene that has a reference, by the methods that choose their own steps.

Errors grow, in these scenes, by the amplification that the reference tells. Scenes whose kernels
nobody else needs are run as plain Python.
"""

from by_hand import nothing_compiled
from dynsim_ros.simulation import Propagator
from dynsim_ros.simulation.layout import Layout
import pytest
from references import amplification, error, load, scenes, State
from simulated import samples

# With each kind of body and of spring, alone and together.
SOFT = ('S1', 'S2', 'moving_anchor', 'spin_in_whirl', 'pulling_at_each_other', 'chain',
        'any_inertia', 'four_bodies')
STIFF = ('S2', 'spin_in_whirl', 'pulling_at_each_other', 'strong_damper', 'stiff_pair')
# Of the kinds of sphere_on_spring and of particle_on_spring.
COMPILED = ('S1', 'S2', 'S3q', 'S3q8', 'S3b', 'S3b8', 'at_rest', 'fast_ball', 'sphere_on_spring',
            'particle_on_spring')


def error_at_first_time(name, method, tolerance):
    scene, times, motions = load(name)
    settings = {'integrator': method, 'tolerance': tolerance}
    if name in COMPILED and (name, method) != ('S1', 'dop853'):
        state = samples(scene, times[0], 1 / times[0], **settings)[0][-1]
    else:
        with nothing_compiled():
            state = Propagator(scene, **settings).end_state(times[0])
    return error(State(Layout(scene), state), motions[0])


@pytest.mark.parametrize('name', scenes())
def test_auto(name):
    assert error_at_first_time(name, 'auto', 1e-6) < 1e-6 * max(2, amplification(name) / 100)


@pytest.mark.parametrize('name, method, tolerance', [
    *((name, method, 1e-8) for name in SOFT for method in ('extrapolation', 'dop853')),
    *((name, 'radau', 1e-8) for name in STIFF), *((name, 'stiff', 1e-4) for name in STIFF)])
def test_methods(name, method, tolerance):
    assert error_at_first_time(name, method, tolerance) < 3 * tolerance
