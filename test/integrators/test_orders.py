# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Orders of convergence: of steps of fixed length, of the error estimates, of the dense outputs.

Measured against newton_euler.py, in position, velocity, orientation and angular velocity each.
With 16 digits an order as high as that of the whole extrapolation can be seen over one halving
only: it is measured with fewer sequences, too.
"""

import functools

from by_hand import ByHand, errors
from dynsim_ros.integrators import gragg, methods, stormer
from dynsim_ros.integrators.lane_schedule import FINER, QUICK
from dynsim_ros.scene import parse_scene
from newton_euler import NewtonEuler
import numpy as np
import pytest

EVERYTHING = parse_scene("""
gravity: 9.81
down: [0.1, -0.2, -1]
air: {linear_drag: 0.3, rotational_drag: 0.2, velocity: [1, 2, -1], angular_velocity: [3, 0, 1]}
anchors:
  fixed: {position: [0, 0, 2]}
  moved: {position: [1, -1, 0], velocity: [0.3, 0.1, -0.2]}
bodies:
  potato: {shape: rigid, mass: 1.1, position: [0.3, -0.2, 0.9], velocity: [0, 1, 0],
           inertia: [[0.6, 0.1, -0.03], [0.1, 0.5, 0.06], [-0.03, 0.06, 0.3]],
           orientation: {axis: [2, -1, 1], angle: 0.8}, angular_velocity: [1, 2, -4]}
springs:
  up: {from: fixed, to: potato, to_offset: [0.2, 0.1, 0.3], stiffness: 70, damping: 0.6,
       natural_length: 0.5}
  aside: {from: potato, from_offset: [0.1, -0.05, 0], to: moved, stiffness: 25,
          natural_length: 0.8}
""")
WITHOUT_LOSSES = parse_scene("""
gravity: 9.81
anchors:
  fixed: {position: [0, 0, 2]}
  moved: {position: [1, -1, 0], velocity: [0.3, 0.1, -0.2]}
bodies:
  dot: {shape: particle, mass: 1, position: [0.3, 0, 1.2], velocity: [0, 0.5, 0]}
  dust: {shape: particle, mass: 0.4, position: [0.3, 1.9, 1.2], velocity: [0, 0.5, 0]}
springs:
  a: {from: fixed, to: dot, stiffness: 30, natural_length: 0.5}
  b: {from: dust, to: dot, stiffness: 10, natural_length: 1.5}
  c: {from: moved, to: dust, stiffness: 10, natural_length: 2.5}
""")


# Sequences of lower orders; more of them than stages.
EVEN = {k: (range(2, 2 * k + 1, 2),) for k in (2, 3, 4)}
ALL = {k: (range(1, k + 1),) for k in (2, 3, 4)}
COARSE, _, _, FINE = [each[1:3] for each in gragg.SEQUENCES]
FINE_STORMER = stormer.SEQUENCES[1][1:3]
SEVEN = (range(1, 8),)
SIX = (2, 4, 6, 8, 10, 12)
MORE = ((2, 4, 6, 8, 10), 3)


def scene_of(method):
    return WITHOUT_LOSSES if method == 'stormer' else EVERYTHING


@functools.cache
def exact(method, *times):
    return NewtonEuler(scene_of(method)).solve(times)


def slopes(lengths, found):
    """Return the orders that fit columns of errors best, but for columns of zeros."""
    found = np.array(found)
    return np.polyfit(np.log(lengths), np.log(found[:, found.any(axis=0)]), 1)[0]


def orders(method, sequences, duration, counts):
    """Return the orders of the error in the middle and at the end of a run of some steps."""
    middle_and_end, found = exact(method, duration / 2, duration), []
    for count in counts:
        states = ByHand(scene_of(method), method, sequences).run(duration, count)
        found.append(np.sqrt(np.mean([
            errors(scene_of(method), states[place], motion) ** 2
            for place, motion in zip((count // 2 - 1, -1), middle_and_end)], axis=0)))
    return slopes(1.0 / np.array(counts), found)


@pytest.mark.parametrize('method, sequences, duration, counts, order', [
    ('gragg', EVEN[2], 0.4, (12, 24, 48), 4), ('gragg', EVEN[3], 0.4, (8, 16, 24), 6),
    ('gragg', EVEN[4], 0.4, (4, 6, 8), 8), ('gragg', MORE, 0.4, (8, 12, 16), 6),
    ('stormer', ALL[2], 0.5, (8, 16, 32), 4), ('stormer', ALL[3], 0.5, (8, 12, 16), 6),
    ('stormer', ALL[4], 0.6, (4, 6, 8), 8),
    ('stiff', ALL[2], 0.3, (16, 32, 64), 2), ('stiff', ALL[3], 0.3, (16, 32, 48), 3),
    ('stiff', (), 0.3, (6, 8, 12), 7), ('dop853', (), 0.5, (4, 6, 8), 8),
    ('rk4', (), 0.5, (16, 32, 64), 4), ('leapfrog', (), 0.5, (32, 64, 128), 2)])
def test_order_of_steps(method, sequences, duration, counts, order):
    found = orders(method, sequences, duration, counts)
    assert len(found) == (2 if method == 'stormer' else 4)
    np.testing.assert_allclose(found, order, rtol=0.1)


@pytest.mark.parametrize('method, sequences, counts, order', [
    ('gragg', COARSE, (2, 4), 10), ('gragg', (), (2, 4), 14), ('gragg', FINE, (2, 4), 12),
    ('stormer', (), (2, 4), 10), ('stormer', FINE_STORMER, (2, 4), 12),
    ('stormer', SEVEN, (2, 4), 14),
    ('radau', (), (4, 6), 15)])
def test_order_of_the_highest_ones(method, sequences, counts, order):
    found = orders(method, sequences, 1.2, counts)
    assert (found > order - 1.5).all()


@pytest.mark.parametrize('method, sequences, lengths, order', [
    ('gragg', EVEN[3], (0.04, 0.02, 0.01), 5), ('gragg', EVEN[4], (0.06, 0.04, 0.03), 7),
    ('gragg', (), (0.4, 0.3, 0.13), 13), ('gragg', FINE, (0.4, 0.3, 0.13), 11),
    ('gragg', COARSE, (0.5, 0.4, 0.3, 0.2, 0.15, 0.1, 0.07), 9),
    ('stormer', ALL[3], (0.08, 0.04, 0.02), 5), ('stormer', ALL[4], (0.16, 0.08, 0.06), 7),
    ('stormer', (), (0.9, 0.7, 0.5, 0.35), 9),
    ('stormer', FINE_STORMER, (1.2, 0.9, 0.7, 0.5, 0.35), 11),
    ('stormer', SEVEN, (0.7, 0.5, 0.35, 0.25), 13),
    ('stiff', ALL[3], (0.01, 0.005, 0.0025), 3), ('stiff', ALL[4], (0.01, 0.005, 0.0025), 4),
    ('stiff', (), (0.04, 0.02, 0.01), 7), ('dop853', (), (0.1, 0.07, 0.05), 8),
    ('radau', (), (0.3, 0.2, 0.1), 8)])
def test_order_of_the_error_estimate(method, sequences, lengths, order):
    hand = ByHand(scene_of(method), method, sequences)
    found = slopes(lengths, [[np.linalg.norm(hand.step(0.0, h, hand.start)[1])] for h in lengths])
    np.testing.assert_allclose(found, order, rtol=0.12)


def test_the_loop_knows_the_orders_of_the_error_estimates():
    assert [methods.gragg_extrapolation(each).power for each in gragg.SEQUENCES] == [9, 13, 13, 11]
    assert [methods.stormer_extrapolation(each).power for each in stormer.SEQUENCES] == [9, 11]
    assert [each().power for each in (methods.stiff, methods.dop853, methods.radau)] == [7, 8, 8]


@pytest.mark.parametrize('method, sequences, lengths, substeps, order', [
    ('gragg', (), (0.25, 0.2, 0.15), SIX, 13), ('gragg', (), (0.4, 0.3, 0.2), FINER, 11),
    ('gragg', (), (0.4, 0.3, 0.2), QUICK, 11), ('stormer', SEVEN, (0.6, 0.4, 0.3), SIX, 13),
    ('stormer', (), (0.6, 0.4, 0.3), QUICK, 10), ('stiff', (), (0.04, 0.03, 0.02), (), 8),
    ('dop853', (), (0.2, 0.1, 0.05), (), 8), ('radau', (), (0.3, 0.2, 0.1), (), 8)])
def test_order_of_the_dense_output(method, sequences, lengths, substeps, order):
    fractions = (0.07, 0.2, 0.35, 0.5, 0.65, 0.8, 0.93)
    hand, found = ByHand(scene_of(method), method, sequences), []
    for h in lengths:
        states = hand.dense(0.0, h, hand.start, fractions, substeps)
        motions = exact(method, *(fraction * h for fraction in fractions))
        found.append(np.max([errors(scene_of(method), *pair) for pair in zip(states, motions)],
                            axis=0))
    assert (slopes(lengths, found) > order - 0.6).all()
