# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The equations of motion of a scene, written once for every kind of number.

Written for the benchmarks, without the formulas of the package: what the two agree on was not
copied. For the kinds of numbers see algebra.py, for the state states.py.
"""

from algebra import (add, columns, cross, dot, is_zero, minus, numbers_of, scale, subtract, times)
from dynsim_ros.scene import Rigid
import numpy as np
from states import is_round, moments_of_inertia, Places


def rates(scene, numbers, t, y):
    """Return dy/dt as a list; t and y: numbers of the kind."""
    return _Rates(scene, numbers, t, y).result()


class _Rates:
    def __init__(self, scene, numbers, t, y):
        self.scene, self.numbers, self.t, self.y = scene, numbers, t, list(y)
        self.places = Places(scene)
        count = len(self.places.bodies)
        self.forces = [[0.0] * 3 for _ in range(count)]
        self.moments = [[0.0] * 3 for _ in range(count)]

    def number(self, value):
        return numbers_of(self.numbers, value)

    def vector(self, values):
        return [self.number(value) for value in values]

    def result(self):
        for spring in self.scene.springs:
            self.spring(spring)
        if self.scene.air is not None:
            self.air(self.scene.air)
        bodies = range(len(self.places.bodies))
        rigid = range(self.places.rigid)
        parts = [self.y[self.places.velocity(i)] for i in bodies]
        parts += [self.acceleration(i) for i in bodies]
        parts += [self.turning(i) for i in rigid] + [self.spinning(i) for i in rigid]
        return [self.numbers.of(a) if is_zero(a) else a for part in parts for a in part]

    def end(self, name, offset):
        """Return index of the body or None, position, velocity and arm of an end of a spring."""
        member = self.scene.ends[name]
        if name not in self.places.names:
            velocity = self.vector(member.velocity)
            return None, add(self.vector(member.position), scale(self.t, velocity)), velocity, None
        i = self.places.names.index(name)
        position, velocity = self.y[self.places.position(i)], self.y[self.places.velocity(i)]
        if not isinstance(member, Rigid):
            return i, position, velocity, None
        offset = self.vector(member.default_offset if offset is None else offset)
        arm = [0.0] * 3
        for part, column in zip(offset, columns(self.y[self.places.orientation(i)], self.number)):
            arm = add(arm, scale(part, column))
        return i, add(position, arm), add(velocity, cross(self.angular_velocity(i), arm)), arm

    def spring(self, spring):
        p, r_p, v_p, p_arm = self.end(spring.from_, spring.from_offset)
        q, r_q, v_q, q_arm = self.end(spring.to, spring.to_offset)
        d = subtract(r_q, r_p)
        inverse = self.numbers.inverse_sqrt(dot(d, d))
        # The force is -(k (L - L_n) + b dL/dt) d / L with dL/dt = v . d / L.
        stiffness = self.number(spring.stiffness)
        pull = minus(times(times(stiffness, self.number(spring.natural_length)), inverse),
                     stiffness)
        if spring.damping:
            rate = times(dot(subtract(v_q, v_p), d), inverse * inverse)
            pull = minus(pull, times(self.number(spring.damping), rate))
        force = scale(pull, d)
        self.apply(q, q_arm, force)
        self.apply(p, p_arm, [-a for a in force])

    def apply(self, i, arm, force):
        if i is not None:
            self.forces[i] = add(self.forces[i], force)
        if arm is not None:
            self.moments[i] = add(self.moments[i], cross(arm, force))

    def air(self, air):
        drag, whirl_drag = self.number(air.linear_drag or 0), self.number(air.rotational_drag or 0)
        for i in range(len(self.places.bodies)):
            wind = subtract(self.y[self.places.velocity(i)], self.vector(air.velocity))
            self.forces[i] = subtract(self.forces[i], scale(drag, wind))
        for i in range(self.places.rigid):
            whirl = subtract(self.angular_velocity(i), self.vector(air.angular_velocity))
            self.moments[i] = subtract(self.moments[i], scale(whirl_drag, whirl))

    def acceleration(self, i):
        inverse = self.number(1.0) / self.number(self.places.bodies[i].mass)
        weight = scale(self.number(self.scene.gravity or 0), self.vector(self.scene.down))
        return add(scale(inverse, self.forces[i]), weight)

    def turning(self, i):
        """Return dq/dt: (0, omega) * q / 2, or q * (0, omega) / 2 with omega in body axes."""
        w, x, y, z = self.y[self.places.orientation(i)]
        half = self.number(0.5)
        a, b, c = (half * part for part in self.y[self.places.angular_velocity(i)])
        if is_round(self.places.bodies[i]):
            return [-a * x - b * y - c * z, a * w + b * z - c * y, b * w + c * x - a * z,
                    c * w + a * y - b * x]
        return [-a * x - b * y - c * z, a * w - b * z + c * y, b * w - c * x + a * z,
                c * w - a * y + b * x]

    def angular_velocity(self, i):
        """Return the angular velocity in world."""
        omega = self.y[self.places.angular_velocity(i)]
        if is_round(self.places.bodies[i]):
            return omega
        total = [0.0] * 3
        for part, axis in zip(omega, columns(self.y[self.places.orientation(i)], self.number)):
            total = add(total, scale(part, axis))
        return total

    def spinning(self, i):
        """Return d omega/dt, from M = I alpha + omega x I omega in body axes."""
        inertia = moments_of_inertia(self.places.bodies[i])
        moment = self.moments[i]
        if is_round(self.places.bodies[i]):
            return scale(self.number(1.0) / self.number(inertia[0][0]), moment)
        if not all(map(is_zero, moment)):
            axes = columns(self.y[self.places.orientation(i)], self.number)
            moment = [dot(axis, moment) for axis in axes]
        spin = self.y[self.places.angular_velocity(i)]
        momentum = [dot(self.vector(row), spin) for row in inertia]
        moment = subtract(moment, cross(spin, momentum))
        return [dot(self.vector(row), moment) for row in np.linalg.inv(inertia)]
