# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Free rotation of any body against the textbook's formulas to many digits, by mpmath."""

from dynsim_ros.integrators.closed_form.principal_axes import principal_axes
from dynsim_ros.integrators.closed_form.rotate_exactly import rotate_back_exactly
from dynsim_ros.integrators.closed_form.torque_free import torque_free
from dynsim_ros.integrators.closed_form.torque_free_setup import torque_free_setup
from integrators.closed_form.exact import (angle_between, EPS, matrix_of, TextbookTop, turn,
                                           turn_about)
import mpmath as mp
import numpy as np
from plain import compiled
import pytest

Q = (0.5, -0.1, 0.7, -0.5)
IDENTITY = (1.0, 0.0, 0.0, 0.0)
TIMES = (0.0, 0.7, 1e4)


def setup(moments, q, omega):
    return torque_free_setup(*principal_axes(np.diag(moments)), q, tuple(map(float, omega)))


def check(moments, q, omega, exact, times=TIMES):
    """Compare with exact(t), a matrix and omega; what is allowed beyond 1e-15 is phase."""
    motion = setup(moments, q, omega)
    spin = np.linalg.norm(motion.omega)
    rate = 2 * abs(motion.precession) + motion.rate + spin
    for t in times:
        matrix, expected = exact(t)
        orientation, found = torque_free(motion, t)
        allowed = 4 * EPS * (4 + rate * t)
        assert angle_between(orientation, matrix) < allowed
        difference = mp.mnorm(mp.matrix(list(found)) - mp.matrix(list(expected)), 'f')
        assert float(difference) <= max(allowed * spin, 1e-99)


def check_with_textbook(moments, q, omega, times=TIMES, digits=60):
    with mp.workdps(digits):
        check(moments, q, omega, TextbookTop(moments, q, omega).at, times)


@pytest.mark.parametrize('spin', [1e-3, 1e5])
@pytest.mark.parametrize('moments', [
    (1.0, 1.5, 2.3), (1.0, 1.001, 1.9), (1.0, 1.8, 1.8001), (1e-6, 1.0, 1.0 + 5e-7),
    (2e-9, 2.1e-9, 4e-9), (5e7, 6e7, 1e8)])
def test_asymmetric_body(moments, spin):
    for direction in np.random.default_rng(3).normal(size=(2, 3)):
        check_with_textbook(moments, Q, spin * direction, digits=40)


def test_against_the_differential_equations_and_so_is_the_textbook():
    a, b, c = moments = 1.0, 1.5, 2.3
    omega = 1.0, -2.0, 0.5

    def rates(_, y):
        u, v, w, *q = y
        return [(b - mp.mpf(c)) / a * v * w, (c - mp.mpf(a)) / b * w * u,
                (a - mp.mpf(b)) / c * u * v, -(q[1] * u + q[2] * v + q[3] * w) / 2,
                (q[0] * u - q[3] * v + q[2] * w) / 2, (q[3] * u + q[0] * v - q[1] * w) / 2,
                (-q[2] * u + q[1] * v + q[0] * w) / 2]

    with mp.workdps(20):
        end = mp.odefun(rates, 0, [mp.mpf(y) for y in (*omega, *IDENTITY)])(1.5)
        matrix, textbook = TextbookTop(moments, IDENTITY, omega).at(1.5)
        q, found = torque_free(setup(moments, IDENTITY, omega), 1.5)
        assert mp.mnorm(matrix_of(end[3:]) - matrix) < 1e-18
        assert mp.mnorm(matrix_of(end[3:]) * mp.matrix(end[:3]) - textbook) < 1e-18
        assert angle_between(q, matrix_of(end[3:])) < 2e-15
        assert mp.mnorm(mp.matrix(list(found)) - textbook) < 4e-15


@pytest.mark.parametrize('moments', [
    (1.5, 1.5 * (1 + 1e-15), 2.0), (1.0, 1.9, 1.9 * (1 + 1e-9)),
    (1.0, 1.0 + 1e-12, 1.0 + 1e-8), (1.0, 1.0 + 2e-15, 1.0 + 1e-14)])
def test_nearly_symmetric_body(moments):
    check_with_textbook(moments, Q, (0.3, -2.0, 1.1))


@pytest.mark.parametrize('distance', [0.3, 1e-3, 1e-8, 1e-15, 1e-30])
def test_close_to_the_middle_axis(distance):
    for omega in [(-0.6 * distance, 3.0, distance), (distance, -3.0, -1e-3 * distance)]:
        check_with_textbook((1.0, 1.5, 2.3), IDENTITY, omega, (0.0, 20.0, 1e3), 150)


@pytest.mark.parametrize('distance', [1e-2, 1e-6])
def test_close_to_the_middle_axis_from_any_orientation(distance):
    with mp.workdps(60):
        omega = matrix_of(Q) * mp.matrix([distance, 3.0, 0.6 * distance])
    omega = tuple(float(w) for w in omega)
    check_with_textbook((1.0, 1.5, 2.3), Q, omega, (0.0, 20.0, 1e3), 60)
    # The angular velocity in body axes, to the digits that this takes.
    found, left = rotate_back_exactly(Q, omega)
    with mp.workdps(60):
        exact = matrix_of(Q).T * mp.matrix(omega)
        assert mp.mnorm(mp.matrix(list(found)) + mp.matrix(list(left)) - exact) < 1e-30


@pytest.mark.parametrize('off', [-1e-3, 1e-6, -1e-10, 1e-14, 0.0])
def test_close_to_the_separatrix(off):
    a, b, c = moments = 1.0, 1.5, 2.3
    omega = (1.0, 0.7, np.sqrt(a * (b - a) / (c * (c - b))) * (1 + off))
    check_with_textbook(moments, IDENTITY, omega, (0.0, 20.0, 1e3), 150)


def test_exactly_on_the_separatrix():
    """The body ends up turning about its middle axis (Landau, section 37, problem 2)."""
    # I_1 (I_2 - I_1) omega_1^2 = I_3 (I_3 - I_2) omega_3^2 without rounding
    a, b, c = moments = 1.0, 2.0, 2.25
    omega = (3.0, 0.5, -4.0)
    motion = setup(moments, IDENTITY, omega)
    last = np.sqrt((a * omega[0] ** 2 + b * omega[1] ** 2 + c * omega[2] ** 2) / b)
    # omega_2 decreases, because omega_1 omega_3 < 0
    rate = -last * np.sqrt((b - a) * (c - b) / (a * c))
    start = np.arctanh(omega[1] / last)
    for t in (0.0, 0.3, 2.0, 20.0, 1e4, 1e9):
        u = start + rate * t
        fading = np.cosh(start) / np.cosh(max(u, -700.0))
        q, found = torque_free(motion, t)
        along = matrix_of(q).T * mp.matrix(list(found))
        np.testing.assert_allclose(
            [float(w) for w in along],
            [omega[0] * fading, last * np.tanh(u), omega[2] * fading], atol=1e-13)


@pytest.mark.parametrize('angle', [1e-3, 1e-9, 1e-40])
@pytest.mark.parametrize('axis', [0, 2])
def test_close_to_a_stable_axis(axis, angle):
    omega = np.array([angle, -0.7 * angle, 0.4 * angle])
    omega[axis] = -7.0
    check_with_textbook((1.0, 1.5, 2.3), IDENTITY, omega, digits=150)


@pytest.mark.parametrize('moments, axis', [((1.0, 1.0, 1.7), 2), ((0.1, 2.0, 2.0), 0),
                                           ((2.0, 0.4, 2.0), 1)])
@pytest.mark.parametrize('omega', [(1.0, -2.0, 3.0), (1e-12, 5.0, 1e-9), (3e4, 4e4, -5e4)])
def test_symmetric_top(moments, axis, omega):
    """A turn about the angular momentum after one about the body's axis (Landau, section 33)."""
    across, along = moments[axis - 1], moments[axis]

    def exact(t):
        start = matrix_of(Q)
        w = start.T * mp.matrix(omega)
        momentum = start * mp.matrix([mp.mpf(i) * u for i, u in zip(moments, w)]) / across
        spin = w[axis] * (1 - mp.mpf(along) / across)
        matrix = turn_about(momentum * t) * start * turn(axis, spin * t)
        return matrix, matrix * turn(axis, -spin * t) * w

    with mp.workdps(50):
        check(moments, Q, omega, exact)


@pytest.mark.parametrize('moments, omega', [
    ((1.0, 1.5, 2.3), (0.0, 0.0, 0.0)), ((1.0, 1.5, 2.3), (0.0, 0.0, -2.0)),
    ((1.0, 1.5, 2.3), (0.0, 3.0, 0.0)), ((1.0, 1.5, 2.3), (1e5, 0.0, 0.0)),
    ((2.0, 2.0, 2.0), (1.0, -2.0, 3.0)), ((1.0, 1.0, 1.9), (4.0, 1.0, 0.0)),
    ((1.0, 1.7, 1.7), (0.0, 1.0, -5.0)), ((1.0, 1.5, 2.3), (1e-180, 1e-170, 2e-175))])
def test_steady_rotation(moments, omega):
    with mp.workdps(50):
        check(moments, IDENTITY, omega,
              lambda t: (turn_about([mp.mpf(w) * t for w in omega]), omega))


def test_compiled_code_gives_the_same_bits_as_python():
    compiled_setup, compiled_rotation = compiled(torque_free_setup), compiled(torque_free)
    random = np.random.default_rng(5)
    for power in range(-14, 3):
        omega = tuple((random.normal(size=3) * (10.0 ** power, 1.0, 10.0 ** power)).tolist())
        arguments = *principal_axes(np.diag(random.uniform(1, 2, 3))), Q, omega
        motion = torque_free_setup(*arguments)
        t = random.uniform(0, 100)
        assert compiled_setup(*arguments) == motion
        assert compiled_rotation(motion, t) == torque_free(motion, t)
