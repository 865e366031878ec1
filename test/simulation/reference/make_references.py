# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Write references.json: where the bodies of each scene are, to some 12 digits.

    pip install heyoka scipy numba PyYAML
    PYTHONPATH=.:test python test/simulation/reference/make_references.py

Each scene is solved twice: by heyoka (Taylor series of adaptive order, tolerance 1e-18) with
quaternions and Euler's equation in body axes, written in this file; and by scipy's DOP853 (rtol
1e-13) with rotation matrices and angular momenta, written in newton_euler.py. Nothing is written
unless the two agree to AGREEMENT in every number. What is written is heyoka's. The double pendulum
is chaotic, errors grow tenfold in half a second: its reference ends at 1 s.
"""

import json
from pathlib import Path

from dynsim_ros.scene import load_scene, Rigid, scene_names
import heyoka as hy
from newton_euler import inertia_matrix, NewtonEuler, rotation_distance
import numpy as np
from scipy.spatial.transform import Rotation

AGREEMENT = 2e-11
DURATIONS = {'double_pendulum_of_spheres': 1.0}
FILE = Path(__file__).with_name('references.json')


def cross(a, b):
    """Return the vector product of two arrays of expressions."""
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                     a[0] * b[1] - a[1] * b[0]])


class Symbols:
    """The variables of one body: r, v in world; q = (w, x, y, z); omega along body axes."""

    def __init__(self, body):
        def several(kind, letters):
            return np.array([hy.make_vars(f'{kind}_{letter}_{body.name}') for letter in letters])
        self.body = body
        self.turns = isinstance(body, Rigid)
        self.r, self.v = several('r', 'xyz'), several('v', 'xyz')
        self.force, self.moment = np.zeros(3, dtype=object), np.zeros(3, dtype=object)
        self.initial = [*body.position, *body.velocity]
        if self.turns:
            self.q, self.omega = several('q', 'wxyz'), several('w', 'xyz')
            w, x, y, z = self.q
            self.matrix = np.array([
                [w * w + x * x - y * y - z * z, 2. * (x * y - w * z), 2. * (x * z + w * y)],
                [2. * (x * y + w * z), w * w - x * x + y * y - z * z, 2. * (y * z - w * x)],
                [2. * (x * z - w * y), 2. * (y * z + w * x), w * w - x * x - y * y + z * z]])
            q = np.array(body.orientation)
            start = Rotation.from_quat([*q[1:], q[0]]).inv().apply(body.angular_velocity)
            self.initial += [*q, *start]

    def equations(self):
        """Return the list of (variable, derivative)."""
        pairs = [*zip(self.r, self.v), *zip(self.v, self.force / self.body.mass)]
        if self.turns:
            w, x, y, z = self.q
            a, b, c = self.omega
            pairs += zip(self.q, [0.5 * (-x * a - y * b - z * c), 0.5 * (w * a - z * b + y * c),
                                  0.5 * (z * a + w * b - x * c), 0.5 * (-y * a + x * b + w * c)])
            inertia = inertia_matrix(self.body)
            left = self.matrix.T @ self.moment - cross(self.omega, inertia @ self.omega)
            pairs += zip(self.omega, np.linalg.inv(inertia) @ left)
        return [(variable, hy.expression(rate) if isinstance(rate, float) else rate)
                for variable, rate in pairs]


def add_springs(scene, bodies):
    """Add the forces of all springs and dampers to the bodies."""
    for spring in scene.springs:
        ends = []
        for name, offset in ((spring.from_, spring.from_offset), (spring.to, spring.to_offset)):
            if name not in bodies:
                ends.append((np.array(scene.ends[name].position), np.zeros(3), None, None))
                continue
            body, arm, velocity = bodies[name], np.zeros(3), bodies[name].v
            if body.turns:
                fixed = np.array([0., 0., body.body.radius] if offset is None else offset)
                arm = body.matrix @ fixed
                velocity = velocity + body.matrix @ cross(body.omega, fixed)
            ends.append((body.r + arm, velocity, arm, body))
        gap, speed = ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]
        length = hy.sqrt(gap @ gap)
        pull = spring.stiffness * (length - spring.natural_length)
        pull = pull + (spring.damping or 0.) * (speed @ gap) / length
        for sign, (_, _, arm, body) in zip((1., -1.), ends):
            if body is not None:
                force = sign * pull * gap / length
                body.force = body.force + force
                if body.turns:
                    body.moment = body.moment + cross(arm, force)


def by_heyoka(scene, times):
    """Return, for each of the times [s], {body: [r, v(, q, omega in world)]}."""
    bodies = {body.name: Symbols(body) for body in scene.bodies}
    add_springs(scene, bodies)
    for body in bodies.values():
        if scene.gravity is not None:
            body.force = body.force + body.body.mass * scene.gravity * np.array(scene.down)
        if scene.air is not None:
            body.force = body.force - scene.air.linear_drag * (
                body.v - np.array(scene.air.velocity))
            body.moment = body.moment - scene.air.rotational_drag * (
                body.matrix @ body.omega - np.array(scene.air.angular_velocity))
    system = [pair for body in bodies.values() for pair in body.equations()]
    start = [number for body in bodies.values() for number in body.initial]
    taylor = hy.taylor_adaptive(system, start, tol=1e-18)
    found = []
    for time in times:
        taylor.propagate_until(time)
        numbers, motion = list(taylor.state), {}
        for name, body in bodies.items():
            mine, numbers = numbers[:len(body.initial)], numbers[len(body.initial):]
            motion[name] = [mine[:3], mine[3:6]]
            if body.turns:
                q = np.array(mine[6:10]) / np.linalg.norm(mine[6:10])
                turn = Rotation.from_quat([*q[1:], q[0]])
                motion[name] += [q.tolist(), turn.apply(mine[10:]).tolist()]
        found.append(motion)
    return found


def disagreement(first, second):
    """Return the largest difference between heyoka's motion and DOP853's."""
    largest = 0.
    for name, (r, v, *turning) in first.items():
        other = second[name]
        largest = max(largest, np.abs(r - other[0]).max(), np.abs(v - other[1]).max())
        if turning:
            largest = max(largest, np.abs(turning[1] - other[3]).max(),
                          rotation_distance(turning[0], Rotation.from_matrix(other[2])))
    return largest


def main():
    """Solve every scene both ways; write the file if they agree."""
    references = {}
    for name in scene_names():
        scene = load_scene(name)
        times = [DURATIONS.get(name, 2.0) * part / 4 for part in (1, 2, 3, 4)]
        motions = by_heyoka(scene, times)
        worst = max(map(disagreement, motions, NewtonEuler(scene).solve(times)))
        print(f'{name}: heyoka and DOP853 differ by at most {worst:.1e}')
        assert worst < AGREEMENT
        references[name] = {'times': times, 'motions': motions}
    FILE.write_text(json.dumps(references, indent=1) + '\n')


if __name__ == '__main__':
    main()
