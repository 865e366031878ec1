# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The motion of a scene once more, written anew to test the package against.

Newton's law and d(angular momentum)/dt = moment, with numpy, rotation matrices and the angular
momentum in world as variables; nothing of the package but the scene's data is used. Solved by
scipy's DOP853.
"""

from dynsim_ros.scene import Box, Rigid, RigidBody, Sphere
import numpy as np
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation


def inertia_matrix(body):
    """Return the (3, 3) inertia of a body about its centre of mass, in body axes."""
    if isinstance(body, Sphere):
        return np.eye(3) * 2 / 5 * body.mass * body.radius ** 2
    if isinstance(body, Box):
        squares = np.square(body.size)
        return np.diag(body.mass / 12 * (squares.sum() - squares))
    given = np.array(body.inertia)
    return {0: given * np.eye(3), 1: np.diag(np.ravel(given)[:3]), 2: given}[given.ndim]


def rotation_of(q):
    """Return the scipy Rotation of a quaternion (w, x, y, z)."""
    return Rotation.from_quat(np.roll(np.asarray(q), -1, axis=-1))


def rotation_distance(q, rotation):
    """Return the angle [rad] between a quaternion (w, x, y, z) and a scipy Rotation."""
    # the largest component of the difference: the angle itself loses half the digits near 0
    return 2 * np.abs((rotation_of(q).inv() * rotation).as_quat()[..., :3]).max()


class NewtonEuler:
    """The motion of one scene; pushes: {body: (force, torque)} in world."""

    def __init__(self, scene, pushes=None):
        self.scene = scene
        self.pushes = pushes or {}
        self.inertia = {b.name: inertia_matrix(b) for b in scene.bodies if isinstance(b, Rigid)}
        sizes = [18 if body.name in self.inertia else 6 for body in scene.bodies]
        starts = np.cumsum([0, *sizes])
        self.places = {body.name: slice(start, start + size)
                       for body, start, size in zip(scene.bodies, starts, sizes)}

    def packed(self, motion):
        """Return the array of variables from {body: (r, v, Rotation, omega)}."""
        parts = []
        for body in self.scene.bodies:
            r, v, *turning = motion[body.name]
            parts += [r, v]
            if body.name in self.inertia:
                matrix = turning[0].as_matrix()
                parts += [matrix.ravel(),
                          matrix @ self.inertia[body.name] @ matrix.T @ turning[1]]
        return np.concatenate(parts)

    def unpacked(self, y):
        """Return {body: (r, v, R, omega)}; R and omega are None for a particle."""
        motion = {}
        for name, place in self.places.items():
            part = y[place]
            matrix = omega = None
            if name in self.inertia:
                matrix = part[6:15].reshape(3, 3)
                inertia = matrix @ self.inertia[name] @ matrix.T
                omega = np.linalg.solve(inertia, part[15:])
            motion[name] = part[:3], part[3:6], matrix, omega
        return motion

    def initial(self):
        """Return the variables at the start."""
        return self.packed({
            b.name: (b.position, b.velocity,
                     *((rotation_of(b.orientation), b.angular_velocity)
                       if isinstance(b, Rigid) else ())) for b in self.scene.bodies})

    def loads(self, t, motion):
        """Return {body: [force, moment about the centre of mass]} in world."""
        scene = self.scene
        loads = {name: np.array(self.pushes.get(name, np.zeros((2, 3))), dtype=float)
                 for name in motion}
        for body in scene.bodies:
            _, v, _, omega = motion[body.name]
            if scene.gravity is not None:
                loads[body.name][0] += body.mass * scene.gravity * np.array(scene.down)
            if scene.air is not None:
                loads[body.name][0] -= (scene.air.linear_drag or 0) * (v - scene.air.velocity)
            if scene.air is not None and omega is not None:
                loads[body.name][1] -= ((scene.air.rotational_drag or 0)
                                        * (omega - scene.air.angular_velocity))
        for spring in scene.springs:
            p = self.end(spring.from_, spring.from_offset, t, motion)
            q = self.end(spring.to, spring.to_offset, t, motion)
            gap = q[0] - p[0]
            length = np.linalg.norm(gap)
            rate = (q[1] - p[1]) @ gap / length
            tension = (spring.stiffness * (length - spring.natural_length)
                       + (spring.damping or 0) * rate)
            for (_, _, arm), name, sign in ((q, spring.to, -1), (p, spring.from_, 1)):
                if name in loads:
                    force = sign * tension * gap / length
                    loads[name] += np.array([force, np.cross(arm, force)])
        return loads

    def end(self, name, offset, t, motion):
        """Return position, velocity and arm of one end of a spring."""
        member = self.scene.ends[name]
        if name not in motion:
            velocity = np.array(member.velocity)
            return member.position + velocity * t, velocity, np.zeros(3)
        r, v, matrix, omega = motion[name]
        if matrix is None:
            return r, v, np.zeros(3)
        edge = {Sphere: lambda: (0, 0, member.radius), RigidBody: lambda: (0, 0, 0),
                Box: lambda: (0, 0, member.size[2] / 2)}[type(member)]()
        arm = matrix @ np.array(edge if offset is None else offset)
        return r + arm, v + np.cross(omega, arm), arm

    def rates(self, t, y):
        """Return dy/dt."""
        motion = self.unpacked(y)
        loads = self.loads(t, motion)
        out = np.empty_like(y)
        for body in self.scene.bodies:
            _, v, matrix, omega = motion[body.name]
            part = out[self.places[body.name]]
            part[:3], part[3:6] = v, loads[body.name][0] / body.mass
            if matrix is not None:
                part[6:15] = np.cross(omega, matrix, axisb=0, axisc=0).ravel()
                part[15:] = loads[body.name][1]
        return out

    def accelerations(self, t, y):
        """Return {body: (linear, angular or None)} from Euler's equation solved in world axes."""
        motion = self.unpacked(y)
        loads = self.loads(t, motion)
        found = {}
        for body in self.scene.bodies:
            _, _, matrix, omega = motion[body.name]
            alpha = None
            if matrix is not None:
                inertia = matrix @ self.inertia[body.name] @ matrix.T
                alpha = np.linalg.solve(
                    inertia, loads[body.name][1] - np.cross(omega, inertia @ omega))
            found[body.name] = loads[body.name][0] / body.mass, alpha
        return found

    def solve(self, times, rtol=1e-13):
        """Return a list of unpacked motions at the times [s], by DOP853."""
        solution = solve_ivp(self.rates, (0, times[-1]), self.initial(), 'DOP853', times,
                             rtol=max(rtol, 2.3e-14), atol=1e-15)
        assert solution.success
        return [self.unpacked(y) for y in solution.y.T]
