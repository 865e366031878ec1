# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
What is left of the tolerance at the end of a run, and at every sample on the way.

The tolerance is that of a step, and small errors of the scenes grow (see amplification in
references.py): the motion keeps it within a factor of three, and of ten where steps are longest.
"""

import functools

from dynsim_ros.simulation.layout import Layout
from newton_euler import NewtonEuler
import numpy as np
import pytest
from references import error, load, State
from simulated import samples

ALL = [10.0 ** -k for k in range(3, 13)]
# Scene, method, tolerances.
CASES = {'stormer': ('S1', 'extrapolation', ALL), 'gragg': ('S2', 'extrapolation', ALL),
         'auto': ('S2', 'auto', ALL), 'dop853': ('S2', 'dop853', ALL),
         'radau': ('S3q', 'radau', ALL[:-2])}
KINDS = pytest.mark.parametrize('name, method, tolerances', CASES.values(), ids=CASES)


@functools.cache
def run(name, method, tolerance, rate, duration=None):
    scene, times, _ = load(name)
    return samples(scene, duration or times[-1], rate, integrator=method, tolerance=tolerance)


def allowed(tolerance):
    return (10.0 if tolerance > 5e-4 else 3.0) * tolerance


@KINDS
def test_the_error_is_of_the_size_of_the_tolerance(name, method, tolerances):
    scene, times, motions = load(name)
    found = []
    for tolerance in tolerances:
        states, _ = run(name, method, tolerance, 1 / times[0])
        found.append([error(State(Layout(scene), states[round(time / times[0])]), motion)
                      for time, motion in zip(times, motions)])
        assert max(found[-1]) < allowed(tolerance)
    # and shrinks with it
    order = np.polyfit(np.log(tolerances), np.log(np.max(found, axis=1)), 1)[0]
    assert 0.8 < order < 1.2


@pytest.mark.parametrize('tolerance', [5e-12, 1e-12])
@pytest.mark.parametrize('name', ['chain', 'four_bodies', 'feather_and_anvil'])
def test_little_is_rounded_where_bodies_hang_on_each_other(name, tolerance):
    scene, times, motions = load(name)
    states, _ = run(name, 'extrapolation', tolerance, 1 / times[0])
    for time, motion in zip(times, motions):
        assert error(State(Layout(scene), states[round(time / times[0])]), motion) < 1e-13


@pytest.mark.parametrize('kind', ['stormer', 'gragg', 'auto', 'dop853'])
def test_a_tenth_of_the_tolerance_costs_less_than_twice_as_much(kind):
    name, method, tolerances = CASES[kind]
    tolerances = tolerances[::3]
    counts = [run(name, method, tolerance, 0.5)[1] for tolerance in tolerances]
    steps = np.array([count['steps'] for count in counts])
    assert (np.diff(steps) >= 0).all()
    assert (np.diff(np.log(steps)) < np.log(2) * -np.diff(np.log10(tolerances))).all()
    assert all(count['rejected'] < 0.2 * count['steps'] for count in counts)


def differences(layout, states, motions):
    """Return the largest difference of positions, velocities and angular velocities."""
    worst = 0.0
    for y, motion in zip(states, motions, strict=True):
        for body, (r, v, _, omega) in motion.items():
            pairs = [(layout.position, r), (layout.velocity, v)]
            if omega is not None:
                pairs.append((layout.angular_velocity, omega))
            for place, exact in pairs:
                worst = max(worst, np.linalg.norm(y[place(body)] - exact)
                            / max(1.0, np.linalg.norm(exact)))
    return worst


@functools.cache
def by_scipy(name):
    return NewtonEuler(load(name)[0]).solve(np.arange(1, 2501) / 250)


@pytest.mark.parametrize('name, method', [('S1', 'extrapolation'), ('S2', 'extrapolation'),
                                          ('S2', 'dop853')])
@pytest.mark.parametrize('tolerance', ALL[:7:3])
def test_every_sample(name, method, tolerance):
    """Samples come from the dense output: hardly a step ends at one."""
    states, _ = run(name, method, tolerance, 250.0)
    assert differences(Layout(load(name)[0]), states[1:], by_scipy(name)) < allowed(tolerance)


@pytest.mark.parametrize('tolerance', [1e-4, 1e-6, 1e-9])
def test_every_sample_of_a_stiff_motion(tolerance):
    """Against dop853, which is compared with scipy's step by step in test_dop853.py."""
    exact, _ = run('S3q', 'dop853', 1e-10, 1000.0, 0.2)
    states, _ = run('S3q', 'radau', tolerance, 1000.0, 0.2)
    scale = np.maximum(1.0, np.linalg.norm(exact[:, 10:13], axis=1))[:, None]
    assert (np.abs(states - exact) / scale).max() < allowed(tolerance)
