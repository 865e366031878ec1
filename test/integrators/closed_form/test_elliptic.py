# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Elliptic integrals and functions against mpmath and scipy, from modulus 0 to modulus 1."""

from dynsim_ros.integrators.closed_form.elliptic import agm, carlson_rf
from dynsim_ros.integrators.closed_form.jacobi import jacobi, jacobi_constants
from integrators.closed_form.exact import EPS
import mpmath as mp
import numpy as np
from plain import compiled
import pytest
from scipy.special import ellipj, ellipkm1

compiled_jacobi = compiled(jacobi)
# 1 - m; that at which one series takes over from the other lies between two of them
COMPLEMENTS = [1.0, 1 - 1e-9, 0.7, 0.5, 0.03, 0.0294373, 0.0294372, 1e-3, 1e-9, 1e-18, 1e-60]


@pytest.mark.parametrize('b', [0.0, 1e-300, 1e-30, 1e-3, 0.5, 1.0, 7.0])
def test_arithmetic_geometric_mean(b):
    # with b = 0 it tends to 0, and slowly
    expected = mp.agm(1, b) if b else 0
    assert abs(agm(1.0, b) - expected) < max(2 * EPS * expected, 1e-12 * (b == 0))


def test_integral_of_the_first_kind():
    random = np.random.default_rng(1)
    for x, y, z in 10.0 ** random.uniform(-40, 10, (50, 3)):
        assert abs(carlson_rf(x, y, z) / mp.elliprf(x, y, z) - 1) < 4 * EPS
        assert abs(carlson_rf(0.0, y, z) / mp.elliprf(0, y, z) - 1) < 4 * EPS


@pytest.mark.parametrize('complement', COMPLEMENTS)
def test_jacobis_functions(complement):
    constants = jacobi_constants(1.0 - complement, complement, 0.3)
    quarter = float(ellipkm1(complement))
    with mp.workdps(90):
        m = 1 - mp.mpf(complement)
        for u in np.array([0, 1e-9, 0.5, 0.99, 1, -1.7, 1000.3]) * quarter:
            expected = [mp.re(mp.ellipfun(name, u, m=m)) for name in ('sn', 'cn', 'dn')]
            for form in (compiled_jacobi, jacobi.py_func):
                found = form(constants, u)[:3]
                assert max(abs(a - b) for a, b in zip(found, expected)) < EPS * (2 + abs(u))


@pytest.mark.parametrize('complement', COMPLEMENTS)
def test_jacobis_functions_against_scipy(complement):
    constants = jacobi_constants(1.0 - complement, complement, 0.3)
    for u in np.linspace(-3, 3, 11):
        # below 1e-9 scipy uses a series in 1 - m whose error is of second order
        np.testing.assert_allclose(jacobi(constants, u)[:3], ellipj(u, 1 - complement)[:3],
                                   atol=3e-8 if complement < 1e-6 else 1e-14)


@pytest.mark.parametrize('complement, c', [(0.9, 0.6), (0.0294373, 1e-3), (0.0294372, 0.9),
                                           (1e-4, 0.2)])
def test_phase_of_the_integral_of_the_third_kind(complement, c):
    constants = jacobi_constants(1.0 - complement, complement, (1.0 - c) / (1.0 + c))
    with mp.workdps(25):
        m, c = 1 - mp.mpf(complement), mp.mpf(c)
        size = mp.sqrt((1 - c ** 2) * (1 - complement * c ** 2)) / c
        for u in (-0.4, 1.7 * constants.period):
            _, _, _, apart, real, imaginary = jacobi(constants, u)
            behind = constants.slope * u - apart - np.arctan2(imaginary, real)
            integral = mp.quad(
                lambda v: 1 / (1 + c * mp.re(mp.ellipfun('dn', v, m=m))) - 1 / (1 + c),
                np.linspace(0, u, 7))
            assert abs(behind - size / 2 * integral) < 4 * EPS * (1 + abs(u))
