# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A particle that moves along its spring, against matrix exponentials, and how close it comes."""

import math

from dynsim_ros.integrators.closed_form.spring_line import (along_spring, is_along, least_length,
                                                            length_along_spring, spring_line)
from dynsim_ros.scene import load_scene, with_values
from integrators.closed_form.exact import error, linear_motion
import mpmath as mp
from newton_euler import NewtonEuler
import numpy as np
from plain import compiled_and_plain
import pytest

ANCHOR, MOVING, WIND, G = (1.0, -1.0, 2.0), (0.0, 0.0, 0.3), (0.0, 0.0, -2.0), (0.0, 0.0, -9.81)
MASS = 0.7


def line(length=1.3, rate=-0.5, stiffness=40.0, damping=0.4, drag=0.2, gravity=G):
    """Return the SpringLine of a particle below its anchor."""
    position = ANCHOR[0], ANCHOR[1], ANCHOR[2] - length
    velocity = 0.0, 0.0, MOVING[2] - rate
    return spring_line(position, velocity, ANCHOR, MOVING, MASS, stiffness, 1.0, damping, gravity,
                       drag, WIND)


@compiled_and_plain(length_along_spring)
@pytest.mark.parametrize('damping', [0.0, 0.4, 2 * np.sqrt(40.0 * MASS) - 0.2, 90.0])
@pytest.mark.parametrize('stiffness', [0.0, 0.01, 40.0, 1e5])
def test_length(formula, damping, stiffness):
    found = line(stiffness=stiffness, damping=damping)
    for t in (0.0, 0.02, 0.9, 14.0):
        with mp.workdps(50):
            square, resistance = mp.mpf(stiffness) / MASS, (mp.mpf(damping) + 0.2) / MASS
            push = mp.mpf(9.81) + mp.mpf(0.2) / MASS * (mp.mpf(2) + 0.3) + square
            exact = linear_motion(t, 1.3, -0.5, resistance, square, push)
        assert error(formula(found, t), exact, 1 + np.sqrt(stiffness / MASS)) < 4e-15 * (
            1 + np.sqrt(stiffness / MASS) * t)


def test_scene_against_the_equations_of_motion_solved_by_scipy():
    scene = with_values(load_scene('particle_on_spring'), {
        'particle.position': (0, 0, 1.2), 'particle.velocity': (0, 0, -0.5),
        'hand.velocity': (0, 0, 0.25)})
    found = along_spring(spring_line((0.0, 0.0, 1.2), (0.0, 0.0, -0.5), (0.0, 0.0, 2.0),
                                     (0.0, 0.0, 0.25), 1.0, 100.0, 0.5, None, (0.0, 0.0, -9.81),
                                     None, None), 4.0)
    r, v, _, _ = NewtonEuler(scene).solve([4.0])[0]['particle']
    np.testing.assert_allclose(found[0], r, atol=2e-11)
    np.testing.assert_allclose(found[1], v, atol=2e-11)


@compiled_and_plain(is_along)
def test_what_is_along_a_direction(formula):
    assert formula((0.0, 0.0, -1.0), (0.0, 0.0, 5.3))
    assert formula((0.6, 0.8, 0.0), (0.0, 0.0, 0.0))
    assert formula((0.6, 0.8, 0.0), (-1.2, -1.6, 0.0))
    assert not formula((0.0, 0.0, -1.0), (1e-300, 0.0, 5.3))


@pytest.mark.parametrize('values', [
    {'damping': 0.0, 'drag': 0.0}, {}, {'rate': 3.0}, {'rate': -6.0}, {'rate': 0.0},
    {'damping': 90.0, 'rate': -30.0}, {'damping': 90.0, 'rate': 30.0},
    {'damping': 90.0, 'rate': 30.0, 'length': 3.0}, {'rate': 9.0, 'length': 3.0},
    {'length': 0.2, 'damping': 2 * math.sqrt(40.0 * 0.7) - 0.2, 'rate': -4.0},
    {'length': 0.2, 'damping': 2 * math.sqrt(40.0 * 0.7) * (1 + 1e-9) - 0.2, 'rate': -4.0},
    {'stiffness': 0.0, 'rate': -4.0}, {'stiffness': 0.0, 'damping': 0.0, 'rate': -4.0}])
def test_least_length_against_many_samples(values):
    found = line(**values)
    for end in (0.01, 0.2, 0.45, 20.0):
        times = np.linspace(0, end, 801)
        lengths = [length_along_spring(found, t)[0] for t in times]
        i = int(np.argmin(lengths))
        # between samples L is at most this much less
        around = length_along_spring(found, times[i])
        most = 40 * (end / 800) ** 2 * (1 + abs(found.push) + found.square)
        least = least_length(found, end)
        assert least <= min(lengths)
        assert least > around[0] - most
    assert least_length(found, math.inf) <= least_length(found, 20.0)
    if found.square > 0.0 and found.resistance > 0.0:
        assert least_length(found, math.inf) == pytest.approx(least, abs=1e-3)


def test_least_length_of_a_spring_without_stiffness():
    away = {'stiffness': 0.0, 'gravity': (0.0, 0.0, 9.81)}
    assert least_length(line(**away), math.inf) == -math.inf
    still = line(stiffness=0.0, damping=0.0, drag=0.0, gravity=(0.0, 0.0, 0.0))
    assert least_length(still, math.inf) == -math.inf
    slowed = line(stiffness=0.0, damping=0.7, drag=0.0, gravity=(0.0, 0.0, 0.0))
    assert least_length(slowed, math.inf) == pytest.approx(1.3 - 0.5 * 0.7 / 0.7)
    resting = line(stiffness=0.0, damping=0.0, drag=0.0, gravity=(0.0, 0.0, 0.0), rate=0.0)
    assert least_length(resting, math.inf) == 1.3
