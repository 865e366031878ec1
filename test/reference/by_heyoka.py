# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The motion of a scene by heyoka: Taylor series of order 40 in quadruple precision (33 digits).

Variables of a body: position, velocity, quaternion, angular velocity along body axes; Euler's
equation. Every number of the scene is taken as the double that it is, nothing is rounded to double
on the way.
"""

from dynsim_ros.scene import Box, Rigid, Sphere
import heyoka as hy
import numpy as np


def number(value):
    """Return a double as an expression in quadruple precision."""
    return hy.expression(hy.real128(float(value)))


def array(values, kind=number):
    """Return numbers of any shape as an array of expressions, or of what kind makes of them."""
    values = np.array(values, dtype=float)
    return np.array([kind(value) for value in values.flat], dtype=object).reshape(values.shape)


def cross(a, b):
    """Return the vector product of two arrays of expressions or numbers."""
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                     a[0] * b[1] - a[1] * b[0]], dtype=object)


def rotation(q):
    """Return the matrix, body to world, of a unit quaternion (w, x, y, z)."""
    w, x, y, z = q
    xy, xz, yz, wx, wy, wz = x * y, x * z, y * z, w * x, w * y, w * z
    return np.array([[w * w + x * x - y * y - z * z, xy + xy - wz - wz, xz + xz + wy + wy],
                     [xy + xy + wz + wz, w * w - x * x + y * y - z * z, yz + yz - wx - wx],
                     [xz + xz - wy - wy, yz + yz + wx + wx, w * w - x * x - y * y + z * z]],
                    dtype=object)


def inertia(body):
    """Return the (3, 3) inertia of a body about its centre of mass in body axes."""
    mass = number(body.mass)
    if isinstance(body, Sphere):
        radius = number(body.radius)
        return np.diag(3 * [mass * radius * radius * number(2) / number(5)])
    if isinstance(body, Box):
        a, b, c = array(body.size) ** 2
        return np.diag([mass * pair / number(12) for pair in (b + c, a + c, a + b)])
    given = array(body.inertia)
    return given if given.ndim == 2 else np.diag(np.broadcast_to(given, 3))


class Symbols:
    """The variables and the loads of one body."""

    def __init__(self, body):
        def several(kind, letters):
            return np.array([hy.make_vars(f'{kind}_{letter}_{body.name}') for letter in letters])
        self.body, self.turns = body, isinstance(body, Rigid)
        self.r, self.v = several('r', 'xyz'), several('v', 'xyz')
        self.force, self.moment = array(np.zeros(3)), array(np.zeros(3))
        self.start = [*array([body.position, body.velocity], hy.real128).flat]
        if self.turns:
            self.q, self.omega = several('q', 'wxyz'), several('w', 'xyz')
            self.matrix = rotation(self.q)
            q = array(body.orientation, hy.real128)
            q = q / (q @ q) ** hy.real128('0.5')
            self.start += [*q, *(rotation(q).T @ array(body.angular_velocity, hy.real128))]

    def end(self, offset):
        """Return position, velocity and arm of a point of the body."""
        if not self.turns:
            return self.r, self.v, array(np.zeros(3))
        offset = array(self.body.default_offset if offset is None else offset)
        arm = self.matrix @ offset
        return self.r + arm, self.v + self.matrix @ cross(self.omega, offset), arm

    def load(self, force, arm):
        """Add a force in world that acts at the end of an arm."""
        self.force = self.force + force
        self.moment = self.moment + cross(arm, force)

    def equations(self):
        """Return the list of (variable, derivative)."""
        pairs = [*zip(self.r, self.v), *zip(self.v, self.force / number(self.body.mass))]
        if self.turns:
            (w, x, y, z), (a, b, c), half = self.q, self.omega, number(0.5)
            pairs += zip(self.q, [half * (-x * a - y * b - z * c), half * (w * a - z * b + y * c),
                                  half * (z * a + w * b - x * c), half * (-y * a + x * b + w * c)])
            i = inertia(self.body)
            adjoint = np.array([cross(i[1], i[2]), cross(i[2], i[0]), cross(i[0], i[1])]).T
            moment = self.matrix.T @ self.moment - cross(self.omega, i @ self.omega)
            pairs += zip(self.omega, adjoint / (i[0] @ adjoint[:, 0]) @ moment)
        return pairs


def add_forces(scene, bodies):
    """Load the bodies with springs and dampers, gravity and air."""
    for spring in scene.springs:
        ends = []
        for name, offset in ((spring.from_, spring.from_offset), (spring.to, spring.to_offset)):
            if name in bodies:
                ends.append(bodies[name].end(offset))
            else:
                velocity = array(scene.ends[name].velocity)
                ends.append((array(scene.ends[name].position) + hy.time * velocity, velocity, 0))
        gap, speed = ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]
        length = hy.sqrt(gap @ gap)
        pull = number(spring.stiffness) * (length - number(spring.natural_length))
        if spring.damping is not None:
            pull = pull + number(spring.damping) * (speed @ gap) / length
        for name, sign, (_, _, arm) in zip((spring.from_, spring.to), (1, -1), ends):
            if name in bodies:
                bodies[name].load(number(sign) * pull / length * gap, arm)
    for body in bodies.values():
        if scene.gravity is not None:
            body.force = body.force + number(body.body.mass) * number(scene.gravity) * array(
                scene.down)
        if scene.air is not None:
            wind, whirl = array(scene.air.velocity), array(scene.air.angular_velocity)
            body.force = body.force - number(scene.air.linear_drag or 0) * (body.v - wind)
            if body.turns:
                body.moment = body.moment - number(scene.air.rotational_drag or 0) * (
                    body.matrix @ body.omega - whirl)


class ByHeyoka:
    """The motion of one scene, from its start or from one nearby."""

    def __init__(self, scene):
        self.bodies = {body.name: Symbols(body) for body in scene.bodies}
        add_forces(scene, self.bodies)
        self.start = [value for body in self.bodies.values() for value in body.start]
        self.taylor = hy.taylor_adaptive(
            [pair for body in self.bodies.values() for pair in body.equations()],
            np.array(self.start), fp_type=hy.real128, compact_mode=True)

    def solve(self, times, start=None):
        """
        Return, for each of the times [s], {body: (r, v) or (r, v, q, omega in world)}.

        start: values of the variables, as self.start; a quaternion in it need not be a unit one.
        """
        self.taylor.time = hy.real128(0)
        self.taylor.state[:] = self.start if start is None else start
        found = []
        for time in times:
            outcome, *_ = self.taylor.propagate_until(hy.real128(time))
            assert outcome == hy.taylor_outcome.time_limit, outcome
            found.append(self.motion())
        return found

    def motion(self):
        """Return the state as one motion."""
        numbers, motion = [*self.taylor.state], {}
        for name, body in self.bodies.items():
            mine, numbers = numbers[:len(body.start)], numbers[len(body.start):]
            parts = [mine[:3], mine[3:6]]
            if body.turns:
                q = np.array(mine[6:10], dtype=object)
                q = q / (q @ q) ** hy.real128('0.5')
                parts += [q, rotation(q) @ np.array(mine[10:], dtype=object)]
            motion[name] = tuple(np.array(part, dtype=object) for part in parts)
        return motion
