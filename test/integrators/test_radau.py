# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How the iteration of radau begins, and what it solves."""

from dynsim_ros.integrators.lu_factors import factorise, substitute
from dynsim_ros.integrators.memory import DENSE_SIZE, STAGES
from dynsim_ros.integrators.radau_tableau import nodes, table
from dynsim_ros.integrators.stages import extrapolate
from dynsim_ros.simulation import Propagator
import numpy as np
import pytest
from references import load

NODES = np.array([float(c) for c in nodes()])


@pytest.mark.parametrize('count', [8, 16, 32])
def test_equations_are_solved_as_numpy_does(count):
    """Also where the largest pivots are in other rows, as in a random matrix almost all are."""
    random = np.random.default_rng(count)
    matrix, right = random.normal(size=(count, count)), random.normal(size=(3, count))
    pivots = count * count
    memory = np.concatenate([matrix.T.ravel(), np.zeros(count), right.ravel()])
    factorise.py_func(count, memory, 0, pivots)
    for number, expected in enumerate(np.linalg.solve(matrix, right.T).T):
        place = pivots + count * (1 + number)
        substitute.py_func(count, memory, 0, pivots, place)
        np.testing.assert_allclose(memory[place:place + count], expected, rtol=0, atol=1e-11)


@pytest.mark.parametrize('ratio', [0.2, 1.0, 2.5])
def test_polynomials_of_the_seventh_degree_are_guessed_exactly(ratio):
    random = np.random.default_rng(1)
    motions = [np.polynomial.Polynomial(random.normal(size=STAGES)) for _ in range(3)]
    kept = np.zeros((DENSE_SIZE + STAGES) * len(motions))
    kept[DENSE_SIZE * len(motions):] = np.concatenate([motion(NODES) for motion in motions])
    memory = np.zeros(STAGES * (len(motions) + STAGES))
    extrapolate.py_func(len(motions), table(), ratio, [motion(1.0) for motion in motions], kept,
                        memory, 0, STAGES * len(motions))
    expected = np.concatenate([motion(1.0 + ratio * NODES) for motion in motions])
    np.testing.assert_allclose(memory[:len(expected)], expected, rtol=1e-9)


def test_four_iterations_are_enough_for_a_step():
    """Each takes two evaluations in a row; from constant accelerations it would be seven."""
    propagator = Propagator(load('S3q')[0], integrator='radau', tolerance=1e-9)
    propagator.end_state(2.0)
    counts = propagator.counts
    assert counts['evaluations'] < 8.5 * (counts['steps'] + counts['rejected'])
