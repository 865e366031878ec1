# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Motions to many digits, by mpmath, from other formulas than those that are tested."""

import functools

import mpmath as mp

EPS = 2.0 ** -52


def error(found, exact, size=1.0):
    """Return the largest |found - exact| over max(size, |exact|); both sequences of numbers."""
    largest = max(abs(mp.mpf(a) - b) for a, b in zip(found, exact, strict=True))
    return float(largest / max(size, *map(abs, exact)))


def matrix_of(q):
    """Return the rotation matrix of a quaternion (w, x, y, z), normalised first."""
    norm = mp.sqrt(sum(mp.mpf(c) ** 2 for c in q))
    w, x, y, z = (mp.mpf(c) / norm for c in q)
    return mp.matrix([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                      [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                      [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def angle_between(q, matrix):
    """Return the angle [rad] between a quaternion (w, x, y, z) and a rotation matrix."""
    return float(mp.mnorm(matrix_of(q) - matrix, 'f') / mp.sqrt(2))


def turn(axis, angle):
    """Return the matrix of a rotation about x, y or z (0, 1, 2)."""
    c, s = mp.cos(angle), mp.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = mp.eye(3)
    matrix[i, i], matrix[i, j], matrix[j, i], matrix[j, j] = c, -s, s, c
    return matrix


def turn_about(vector):
    """Return the matrix of a rotation by a vector (3,), by the exponential of a matrix."""
    x, y, z = vector
    return mp.expm(mp.matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]]))


@functools.cache
def propagator(t, resistance, square):
    """Return (2, 3): y and y' at t from y, y' at 0 and a; y'' + resistance y' + square y = a."""
    with mp.workdps(90):
        rates = mp.matrix([[0, 1, 0], [-mp.mpf(square), -mp.mpf(resistance), 1], [0, 0, 0]])
        return mp.expm(mp.mpf(t) * rates)[:2, :]


def linear_motion(t, y, v, resistance, square, push):
    """Return y and y' at time t, by a matrix exponential; y, v: at time 0, push: a as above."""
    return tuple(propagator(t, resistance, square) * mp.matrix([mp.mpf(y), mp.mpf(v), push]))


class TextbookTop:
    """
    The free rotation of a body by Euler's angles about its angular momentum.

    Landau and Lifshitz, Mechanics, section 37: the third angle by Legendre's incomplete integral.
    moments: ascending, different, about the body's own axes; q: (w, x, y, z); omega: in world.
    """

    def __init__(self, moments, q, omega):
        a, b, c = (mp.mpf(moment) for moment in moments)
        self.start = matrix_of(q)
        w = self.start.T * mp.matrix([mp.mpf(component) for component in omega])
        self.axes = mp.eye(3)
        if c * (c - b) * w[2] ** 2 < a * (b - a) * w[0] ** 2:
            self.axes = mp.matrix([[0, 0, 1], [0, -1, 0], [1, 0, 0]])
            a, c = c, a
        if (self.axes.T * w)[2] < 0:
            self.axes *= mp.diag([1, -1, -1])
        self.w = self.axes.T * w
        self.moments = a, b, c
        twice_energy = sum(i * u * u for i, u in zip(self.moments, self.w))
        square = sum((i * u) ** 2 for i, u in zip(self.moments, self.w))
        across, along = twice_energy * c - square, square - twice_energy * a
        self.momentum = mp.sqrt(square)
        self.amplitudes = (mp.sqrt(across / (a * (c - a))), mp.sqrt(across / (b * (c - b))),
                           mp.sqrt(along / (c * (c - a))))
        self.rate = mp.sign(c - b) * mp.sqrt(along * (c - b) / (a * b * c))
        self.parameter = (b - a) * across / ((c - b) * along)
        self.phase = mp.ellipf(mp.atan2(self.w[1] / self.amplitudes[1],
                                        self.w[0] / self.amplitudes[0]), self.parameter)
        self.frame = self.start * self.axes * self.relative(0)[0].T

    def relative(self, t):
        """Return orientation relative to the angular momentum, and omega, both of these axes."""
        (a, b, c), m = self.moments, self.parameter
        period = 2 * mp.ellipk(m)
        u = self.rate * t + self.phase
        turns = int(mp.nint(u / period))
        sn, cn, dn = (mp.re(mp.ellipfun(name, u - turns * period, m=m))
                      for name in ('sn', 'cn', 'dn'))
        n = -c * (b - a) / (a * (c - b))
        integral = mp.re(mp.ellippi(n, mp.atan2(sn, cn), m)) + 2 * turns * mp.ellippi(n, m)
        sign = (-1) ** turns
        w = [f * g for f, g in zip(self.amplitudes, (sign * cn, sign * sn, dn))]
        precession = self.momentum * (t / c + (c - a) / (a * c * self.rate) * integral)
        matrix = (turn(2, precession) * turn(0, mp.acos(c * w[2] / self.momentum))
                  * turn(2, mp.atan2(a * w[0], b * w[1])))
        return matrix, mp.matrix(w)

    def at(self, t):
        """Return the rotation matrix and the angular velocity in world at time t."""
        matrix, w = self.relative(mp.mpf(t))
        matrix = self.frame * matrix
        return matrix * self.axes.T, matrix * w
