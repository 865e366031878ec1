# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The motion of a scene by extrapolation of the midpoint rule, of order 32, in 50 digits (gmpy2).

Variables of a body: position, momentum, the columns of the rotation matrix, angular momentum, all
in world. Shares neither equations nor method nor code with by_heyoka.py.
"""

from dynsim_ros.scene import Box, Rigid, RigidBody, Sphere
from gmpy2 import context, mpfr, set_context, sqrt
import numpy as np

PRECISION = 166
COLUMNS = 16
TOLERANCE = mpfr('1e-32')


def exact(values):
    """Return doubles as an array of gmpy2's numbers."""
    return np.vectorize(mpfr, otypes=[object])(np.array(values, dtype=float))


def cross(a, b):
    """Return the vector product."""
    (a, b, c), (d, e, f) = a, b
    return np.array([b * f - c * e, c * d - a * f, a * e - b * d], dtype=object)


def inverse_inertia(body):
    """Return the inverse of the inertia in body axes as a (3, 3) array."""
    if isinstance(body, Sphere):
        moments = 3 * [2 * mpfr(body.mass) * mpfr(body.radius) ** 2 / 5]
    elif isinstance(body, Box):
        squares = exact(body.size) ** 2
        moments = mpfr(body.mass) * (squares.sum() - squares) / 12
    elif isinstance(body.inertia, tuple) and isinstance(body.inertia[0], tuple):
        return inverse(exact(body.inertia))
    else:
        moments = np.broadcast_to(exact(body.inertia), 3)
    return np.diag([1 / moment for moment in moments]) + mpfr(0)


def inverse(matrix):
    """Return the inverse of a (3, 3) array, by Gauss and Jordan."""
    rows = np.hstack([matrix, exact(np.eye(3))])
    for i in range(3):
        rows[i] = rows[i] / rows[i, i]
        for j in {0, 1, 2} - {i}:
            rows[j] = rows[j] - rows[j, i] * rows[i]
    return rows[:, 3:]


def columns(q):
    """Return the images of the body axes by a quaternion (w, x, y, z) of any norm."""
    w, *vector = exact(q)
    vector = np.array(vector, dtype=object)
    norm = w * w + vector @ vector
    found = []
    for axis in exact(np.eye(3)):
        once = cross(vector, axis)
        found.append(axis + 2 * (w * once + cross(vector, once)) / norm)
    return found


class ByExtrapolation:
    """The motion of one scene."""

    def __init__(self, scene):
        set_context(context(precision=PRECISION))
        self.scene = scene
        self.inverse = {b.name: inverse_inertia(b) for b in scene.bodies if isinstance(b, Rigid)}
        self.mass = {body.name: mpfr(body.mass) for body in scene.bodies}
        self.weight = {name: mass * mpfr(scene.gravity or 0) * exact(scene.down)
                       for name, mass in self.mass.items()}
        self.anchors = {anchor.name: exact([anchor.position, anchor.velocity])
                        for anchor in scene.anchors}
        self.springs = [(s.from_, self.point(s.from_, s.from_offset), s.to,
                         self.point(s.to, s.to_offset), mpfr(s.stiffness), mpfr(s.natural_length),
                         mpfr(s.damping or 0)) for s in scene.springs]

    def point(self, name, offset):
        """Return an attachment point in body axes; the centre of what has no extent."""
        body = self.scene.ends[name]
        if offset is None:
            offset = {Sphere: lambda: (0, 0, body.radius), RigidBody: lambda: (0, 0, 0),
                      Box: lambda: (0, 0, body.size[2] / 2)}.get(type(body), lambda: (0, 0, 0))()
        return exact(offset)

    def initial(self):
        """Return the variables at the start: rows of three, 2 a particle, 6 a rigid body."""
        rows = []
        for body in self.scene.bodies:
            rows += [exact(body.position), self.mass[body.name] * exact(body.velocity)]
            if isinstance(body, Rigid):
                axes = columns(body.orientation)
                turn = np.array(axes, dtype=object).T
                inertia = turn @ inverse(self.inverse[body.name]) @ turn.T
                rows += [*axes, inertia @ exact(body.angular_velocity)]
        return np.array(rows, dtype=object)

    def motion(self, y):
        """Return {body: (r, v) or (r, v, R, omega)}; R rotates body to world."""
        motion, rows = {}, iter(y)
        for body in self.scene.bodies:
            r, momentum = next(rows), next(rows)
            motion[body.name] = r, momentum / self.mass[body.name]
            if body.name in self.inverse:
                turn = np.array([next(rows), next(rows), next(rows)], dtype=object).T
                omega = turn @ (self.inverse[body.name] @ (turn.T @ next(rows)))
                motion[body.name] += turn, omega
        return motion

    def rates(self, t, y):
        """Return dy/dt."""
        motion, air = self.motion(y), self.scene.air
        force, moment = dict(self.weight), {name: exact((0, 0, 0)) for name in self.inverse}
        for name, (_, v, *turning) in motion.items():
            if air is not None:
                force[name] = force[name] - mpfr(air.linear_drag or 0) * (v - exact(air.velocity))
            if air is not None and turning:
                moment[name] = mpfr(air.rotational_drag or 0) * (
                    exact(air.angular_velocity) - turning[1])
        for p, p_point, q, q_point, stiffness, natural_length, damping in self.springs:
            p_place, p_speed, p_arm = self.end(p, p_point, t, motion)
            q_place, q_speed, q_arm = self.end(q, q_point, t, motion)
            span = q_place - p_place
            length = sqrt(span @ span)
            unit = span / length
            on_q = -(stiffness * (length - natural_length)
                     + damping * ((q_speed - p_speed) @ unit)) * unit
            for name, arm, load in ((q, q_arm, on_q), (p, p_arm, -on_q)):
                if name in force:
                    force[name] = force[name] + load
                if name in moment:
                    moment[name] = moment[name] + cross(arm, load)
        rows = []
        for name, (_, v, *turning) in motion.items():
            rows += [v, force[name]]
            if turning:
                rows += [*(cross(turning[1], axis) for axis in turning[0].T), moment[name]]
        return np.array(rows, dtype=object)

    def end(self, name, point, t, motion):
        """Return position, velocity and arm of one end of a spring."""
        if name in self.anchors:
            position, velocity = self.anchors[name]
            return position + t * velocity, velocity, None
        r, v, *turning = motion[name]
        if not turning:
            return r, v, None
        arm = turning[0] @ point
        return r + arm, v + cross(turning[1], arm), arm

    def solve(self, times):
        """Return, for each of the times [s], what motion returns."""
        t, y, step, found = mpfr(0), self.initial(), mpfr('1e-3'), []
        for time in map(mpfr, times):
            while t < time:
                pieces = int((time - t) / step) + 1
                now = (time - t) / pieces
                y_next, error = self.step(t, y, now)
                if error <= TOLERANCE:
                    t, y = (time if pieces == 1 else t + now), y_next
                change = mpfr('0.9') * (TOLERANCE / (error + TOLERANCE / 2 ** 60)) ** (
                    mpfr(1) / (2 * COLUMNS - 1))
                step = now * min(mpfr(3), max(mpfr('0.2'), change))
            found.append(self.motion(y))
        return found

    def step(self, t, y, step):
        """Return the variables one step on and the difference of the last two columns."""
        first, row = self.rates(t, y), []
        for j in range(1, COLUMNS + 1):
            h = step / (2 * j)
            before, now = y, y + h * first
            for i in range(1, 2 * j):
                before, now = now, before + 2 * h * self.rates(t + i * h, now)
            new = [now]
            for k, old in enumerate(row, 1):
                new.append(new[-1] + (new[-1] - old) / ((mpfr(j) / (j - k)) ** 2 - 1))
            row = new
        difference = np.abs(row[-1] - row[-2]) / (1 + np.abs(row[-1]))
        return row[-1], difference.max()
