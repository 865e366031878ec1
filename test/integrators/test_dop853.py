# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The method of Dormand and Prince step by step against scipy's: steps, errors, dense output."""

import functools

from by_hand import ByHand
from dynsim_ros.integrators import dop853_tableau as ours
from dynsim_ros.integrators.dop853 import dop853
from dynsim_ros.integrators.error_norm import error_norm
from dynsim_ros.integrators.memory import load as load_state, number_row, store
from dynsim_ros.physics.jit import kernel
import numpy as np
import pytest
from references import load
from scipy.integrate import DOP853
from scipy.integrate._ivp import dop853_coefficients as theirs

TABLE = ours.table()


def table_at(place, *shape):
    return TABLE[place:place + np.prod(shape)].reshape(shape)


@functools.cache
def hand(name):
    return ByHand(load(name)[0], 'dop853')


@functools.cache
def steps(name):
    """Return (t, h, state before, state after, rates of the stages, dense output) of each step."""
    taken, by_hand = [], hand(name)
    solver = DOP853(lambda t, y: by_hand.rates(t, y), 0.0, by_hand.start[:by_hand.size], 0.6,
                    rtol=1e-7, atol=1e-7)
    while solver.status == 'running':
        before = solver.y
        assert solver.step() is None
        taken.append((solver.t_old, solver.h_previous, before, solver.y, solver.K_extended.copy(),
                      solver.dense_output()))
    return taken


SCENES = pytest.mark.parametrize('name', ['S1', 'S2', 'any_inertia', 'four_bodies'])


def test_coefficients():
    np.testing.assert_array_equal(table_at(ours.A_AT, 16, 16), theirs.A)
    np.testing.assert_array_equal(table_at(ours.A_AT + 12 * 16, 16)[:12], theirs.B)
    np.testing.assert_array_equal(table_at(ours.C_AT, 16), theirs.C)
    np.testing.assert_array_equal(table_at(ours.E3_AT, 16)[:13], theirs.E3)
    np.testing.assert_array_equal(table_at(ours.E5_AT, 16)[:13], theirs.E5)
    np.testing.assert_array_equal(table_at(ours.D_AT, 4, 16), theirs.D)


@SCENES
def test_each_step_ends_where_that_of_scipy_ends(name):
    taken = steps(name)
    assert len(taken) > 8
    for t, h, before, after, *_ in taken:
        found, _ = hand(name).step(t, h, before)
        # A rounding of 2 m in a stage of S2 is h k r / I times that in angular velocity: 3e-14.
        np.testing.assert_allclose(found, after, rtol=0, atol=6e-14 * abs(after).max())


@kernel
def step(model, drive, data, size, t, h, start, rate_there, memory, end, error_there):
    """Take a step from arrays to arrays."""
    y, y_new = number_row(None, memory, 0, 13), number_row(None, memory, 1, 13)
    rate, error = number_row(None, memory, 2, 13), number_row(None, memory, 3, 13)
    load_state(size, start, y)
    load_state(size, rate_there, rate)
    dop853(model, drive, data, size, t, h, y, rate, memory, y_new, error)
    store(size, y_new, end)
    store(size, error, error_there)


def test_compiled_steps_have_the_same_bits():
    by_hand = hand('S2')
    for t, h, before, *_ in steps('S2'):
        end, error = np.zeros(13), np.zeros(13)
        step(by_hand.model, by_hand.drive, by_hand.plan, 13, t, h, before,
             by_hand.rates(t, before), by_hand.memory, end, error)
        for compiled, plain in zip((end, error), by_hand.step(t, h, before)):
            np.testing.assert_array_equal(compiled, plain)


@SCENES
def test_the_error_is_that_of_scipy(name):
    """The vector is along scipy's; its norm is made of fifth and third order as scipy's is."""
    by_hand = hand(name)
    for t, h, before, after, stages, _ in steps(name):
        _, found = by_hand.step(t, h, before)
        fifth, third = (h * stages[:13].T @ weights for weights in (theirs.E5, theirs.E3))
        five, three = (error_norm(by_hand.bodies, by_hand.rigid, after, error)
                       for error in (fifth, third))
        expected = fifth * five / np.hypot(five, 0.1 * three)
        np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-14 * abs(after).max())


@pytest.mark.parametrize('name', ['S1', 'chain'])
def test_the_dense_output_is_that_of_scipy(name):
    """Without bodies that turn: scipy does not normalise quaternions."""
    fractions = np.linspace(0.0, 1.0, 6)
    for t, h, before, after, _, dense in steps(name)[1:-1:4]:
        found = hand(name).dense(t, h, before, fractions)
        expected = dense(t + fractions * h).T
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-13 * abs(after).max())
