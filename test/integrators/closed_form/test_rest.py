# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A body is at rest when what is left of its forces is rounding, and moves when it is more."""

from dynsim_ros.integrators.closed_form.rest import cancels, spring_size
import numpy as np
from plain import compiled_and_plain
from scipy.optimize import brentq

ZERO = (0.0, 0.0, 0.0)


def hanging(stiffness, mass, height):
    """Return the force on a particle that hangs as well as double precision can place it."""
    place = brentq(lambda z: stiffness * (height - z - 0.5) - mass * 9.81, height - 10, height,
                   xtol=1e-300, rtol=1e-15)
    total = stiffness * (height - place - 0.5) - mass * 9.81
    size = spring_size(stiffness, 0.5, (0.0, 0.0, height), (0.0, 0.0, place)) + mass * 9.81
    return (0.0, 0.0, total), size, place


@compiled_and_plain(cancels)
def test_a_particle_that_hangs_is_at_rest(formula):
    random = np.random.default_rng(2)
    for power in random.uniform(-3, 9, 100):
        stiffness = 10.0 ** power
        total, size, _ = hanging(stiffness, stiffness * random.uniform(0, 0.5), 2.0)
        assert formula(total, size)


def test_a_particle_a_little_off_is_not_at_rest():
    total, size, place = hanging(100.0, 1.0, 2.0)
    moved = total[0], total[1], total[2] - 100.0 * 1e-13 * abs(place)
    assert cancels(total, size)
    assert not cancels(moved, size)


@compiled_and_plain(cancels)
def test_no_force_is_at_rest_and_the_smallest_is_not(formula):
    assert formula(ZERO, 0.0)
    assert not formula((1e-150, 0.0, 0.0), 1e-150)
