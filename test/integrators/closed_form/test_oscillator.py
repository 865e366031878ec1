# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The damped oscillator against matrix exponentials of many digits, at every damping."""

from dynsim_ros.integrators.closed_form.oscillator import responses
from integrators.closed_form.exact import EPS, propagator
import mpmath as mp
import numpy as np
from plain import compiled_and_plain
import pytest

# (w t)^2 and 2 g t; those near 1 and 2 lie on both sides of where the formulas change
SQUARES = [0.0, 1e-300, 1e-9, 0.2, 0.999, 1.001, 6.0, 1e5]
RESISTANCES = [0.0, 1e-300, 1e-9, 0.3, 0.99, 1.01, 1.99, 2.01, 90.0, 1e4]


def check(formula, t, g, square):
    with mp.workdps(90):
        exact = propagator(t, 2 * mp.mpf(g), square)
    c, s, p, s_slope = exact[0, 0], exact[0, 1], exact[0, 2], exact[1, 1]
    found = formula(t, g, square)
    phase = np.sqrt(square) * t if square > g * g else min(g * t, 50)
    # the largest size that each has at any time, as far as rounding of the phase goes
    sizes = 1, min(t, 1 / np.sqrt(square) if square else t), 1, abs(p)
    if square > g * g:
        sizes = *sizes[:3], min(t * t, 1 / square)
    for value, exact, size in zip(found, (c, s, s_slope, p), sizes):
        assert abs(value - exact) <= 4 * EPS * (1 + phase) * size


@compiled_and_plain(responses)
@pytest.mark.parametrize('t', [1e-3, 1e4])
def test_responses(formula, t):
    for square in SQUARES:
        for resistance in RESISTANCES:
            check(formula, t, 0.5 * resistance / t, square / (t * t))


@compiled_and_plain(responses)
@pytest.mark.parametrize('off', [0.0, 1e-16, 1e-13, 1e-8, 1e-3])
def test_nearly_critical_damping(formula, off):
    for g in (0.01, 0.5, 1.0, 3.0, 30.0):
        for sign in (1, -1):
            check(formula, 1.0, g, g * g * (1 + sign * off))


def test_time_zero():
    for g in (0.0, 1.0, 3.0):
        assert responses(0.0, g, 4.0) == (1.0, 0.0, 1.0, 0.0)
