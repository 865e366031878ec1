# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""After thousands of turns the state is as exact as at the beginning, against mpmath."""

from dynsim_ros.integrators.closed_form import (free_spin, on_centred_springs, principal_axes,
                                                seconds, spin_down, torque_free,
                                                torque_free_in_full)
from dynsim_ros.integrators.closed_form.torque_free_rates import complete_integrals
from integrators.closed_form.exact import (angle_between, error, linear_motion, matrix_of,
                                           TextbookTop, turn_about)
import mpmath as mp
import numpy as np
import pytest

Q = (0.5, -0.1, 0.7, -0.5)
# ns: whole seconds, and times that no float is equal to
TIMES = [10_000_000_000_000, 12_345_678_901_234, 3_141_592_653]


def exact_time(time_ns):
    return mp.mpf(time_ns) / 10 ** 9


@pytest.mark.parametrize('time_ns', [0, 1, 100_000_001, *TIMES, 2 ** 53 - 1])
def test_seconds_are_exact(time_ns):
    t, left = seconds(time_ns)
    with mp.workdps(40):
        assert abs(mp.mpf(t) + mp.mpf(left) - exact_time(time_ns)) <= 1e-31 * exact_time(time_ns)


@pytest.mark.parametrize('time_ns', TIMES)
def test_free_spin(time_ns):
    omega = (3.1, -47.3, 12.7)
    with mp.workdps(40):
        exact = turn_about([exact_time(time_ns) * w for w in omega]) * matrix_of(Q)
        t, left = seconds(time_ns)
        assert angle_between(free_spin(t, Q, omega, left)[0], exact) < 1e-15


@pytest.mark.parametrize('time_ns', TIMES)
def test_spin_in_air_that_whirls(time_ns):
    omega, whirl, inertia, drag = (-8.0, 4.0, 2.0), (4.0, -2.0, -1.0), 0.5, 0.3
    with mp.workdps(50):
        rate = mp.mpf(drag) / mp.mpf(inertia)
        turn = [linear_motion(exact_time(time_ns), 0, w, rate, 0, rate * a)[0]
                for w, a in zip(omega, whirl)]
        t, left = seconds(time_ns)
        q, _, _ = spin_down(t, Q, omega, inertia, drag, whirl, (0.0, 0.0, 0.0), left)
        assert angle_between(q, turn_about(turn) * matrix_of(Q)) < 1e-14


@pytest.mark.parametrize('time_ns', TIMES)
@pytest.mark.parametrize('drag', [None, 1e-6])
def test_swing(time_ns, drag):
    position, velocity, centre, g = (0.3, -2.0, 1.2), (1.0, 0.5, -3.0), (0.0, 0.1, 2.0), -9.81
    t, left = seconds(time_ns)
    found = on_centred_springs(t, position, velocity, 0.7, 43.0, centre, None, (0.0, 0.0, g),
                               drag, None, left)
    with mp.workdps(60):
        parts = [linear_motion(exact_time(time_ns), mp.mpf(r) - c, v, mp.mpf(drag or 0) / 0.7,
                               mp.mpf(43) / mp.mpf(0.7), a)
                 for r, v, c, a in zip(position, velocity, centre, (0, 0, mp.mpf(g)))]
        assert error(found[0], [part[0] + c for part, c in zip(parts, centre)]) < 2e-15
        assert error(found[1], [part[1] for part in parts]) < 1e-14


@pytest.mark.parametrize('moments', [
    (1.0, 1.5, 2.3), (1.0, 1.8, 1.8001), (1e-6, 1.0, 1.0 + 5e-7), (1.0, 1.0 + 1e-9, 1.7)])
@pytest.mark.parametrize('omega', [(1.0, -2.0, 3.0), (0.01, 6.0, 0.01), (100.0, -200.0, 37.0)])
def test_free_rotation(moments, omega):
    motion = torque_free_in_full(*principal_axes(np.diag(moments)), Q, omega)
    with mp.workdps(50):
        exact = TextbookTop(moments, Q, omega)
        for time_ns in TIMES:
            matrix, spin = exact.at(exact_time(time_ns))
            q, found = torque_free(motion, *seconds(time_ns))
            assert angle_between(q, matrix) < 3e-15
            assert error(found, spin) < 3e-15


def test_free_rotation_close_to_the_middle_axis():
    """What is left of the rounding of the state itself grows with each turn of the axis."""
    motion = torque_free_in_full(*principal_axes(np.diag((1.0, 1.5, 2.3))), (1.0, 0.0, 0.0, 0.0),
                                 (1e-12, 3.0, -1e-11))
    with mp.workdps(60):
        exact = TextbookTop((1.0, 1.5, 2.3), (1.0, 0.0, 0.0, 0.0), (1e-12, 3.0, -1e-11))
        for time_ns in TIMES:
            matrix, _ = exact.at(exact_time(time_ns))
            assert angle_between(torque_free(motion, *seconds(time_ns))[0], matrix) < 1e-13


def test_steady_rotation():
    motion = torque_free_in_full(*principal_axes(np.diag((1.0, 1.5, 2.3))), (1.0, 0.0, 0.0, 0.0),
                                 (0.0, 0.0, 77.7))
    with mp.workdps(40):
        for time_ns in TIMES:
            matrix = turn_about((0, 0, exact_time(time_ns) * mp.mpf(77.7)))
            assert angle_between(torque_free(motion, *seconds(time_ns))[0], matrix) < 1e-15


def in_two(number):
    """Return a number of mpmath as the sum of two floats."""
    return float(number), float(number - float(number))


@pytest.mark.parametrize('complement', ['1', '0.7', '1e-3', '1e-20', '1e-60'])
@pytest.mark.parametrize('characteristic', ['0', '-0.3', '-1e6', '-1e-9'])
def test_complete_integrals(complement, characteristic):
    """To twice the digits of a float, from arguments that are rounded to these."""
    with mp.workdps(120):
        root, square = in_two(mp.sqrt(mp.mpf(complement))), in_two(mp.mpf(characteristic))
        first, third = complete_integrals(root, square)
        m = 1 - (mp.mpf(root[0]) + root[1]) ** 2
        assert abs((mp.mpf(first[0]) + first[1]) / mp.ellipk(m) - 1) < 2e-32
        exact = mp.ellippi(mp.mpf(square[0]) + square[1], m)
        # 1 is taken from something as near to it as one over the characteristic
        assert abs((mp.mpf(third[0]) + third[1]) / exact - 1) < 2e-32 * (1 + abs(square[0]))


def test_free_rotation_at_the_border_of_two_periods():
    """Where u is the quarter period but for rounding, both sides give the same state."""
    motion = torque_free_in_full(*principal_axes(np.diag((1.0, 1.5, 2.3))), Q, (0.1, 6.0, 0.2))
    border = (motion.jacobi.period / 2 - motion.phase) / motion.rate
    for turns in range(4):
        t = border + turns * motion.period
        states = [np.concatenate(torque_free(motion, t, k * 1e-17)) for k in range(-9, 10)]
        states += [np.concatenate(torque_free(motion, np.nextafter(t, end))) for end in (0, 99)]
        assert max(np.abs(state - states[0]).max() for state in states) < 1e-13
