# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
PyBullet: it has no spring between points, so the forces are applied from outside at every step.

They come from the same compiled equations as those for numbalsoda: what is timed is PyBullet.
"""

import numpy as np
from states import initial, is_round, moments_of_inertia, Places
from symbols import compiled

from . import installed, Run, Setting, steps


def available():
    return installed('pybullet')[1]


def supports(case):
    if not all(is_round(body) for body in Places(case.scene).bodies[:Places(case.scene).rigid]):
        return 'what turns it is set up for bodies with the same inertia about every axis'
    return None


def settings(case):
    return [Setting('semi-implicit Euler', step) for step in steps(case.duration, 0.1, 1e-5)]


def prepare(case, setting):
    import pybullet

    scene, places, step = case.scene, Places(case.scene), setting.value
    world, bodies, masses, inertias = make_world(pybullet, scene, places, step)
    rates, y0, count = compiled(scene), initial(scene), round(case.duration / step)
    rates(0.0, y0, np.empty_like(y0))

    def run():
        put(pybullet, world, bodies, places, y0)
        y, out = y0.copy(), np.empty_like(y0)
        for k in range(count):
            get(pybullet, world, bodies, places, y)
            rates(k * step, y, out)
            for i, body in enumerate(bodies):
                pybullet.applyExternalForce(
                    body, -1, masses[i] * out[places.velocity(i)], y[places.position(i)],
                    pybullet.WORLD_FRAME, physicsClientId=world)
                if i < places.rigid:
                    pybullet.applyExternalTorque(
                        body, -1, inertias[i] * out[places.angular_velocity(i)],
                        pybullet.WORLD_FRAME, physicsClientId=world)
            pybullet.stepSimulation(physicsClientId=world)
        get(pybullet, world, bodies, places, y)
        return y

    return Run(run, lambda result: result.copy())


def make_world(pybullet, scene, places, step):
    """Return the world, its bodies, their masses and moments of inertia."""
    world = pybullet.connect(pybullet.DIRECT)
    pybullet.setTimeStep(step, physicsClientId=world)
    bodies, masses, inertias = [], [], []
    for i, body in enumerate(places.bodies):
        bodies.append(pybullet.createMultiBody(baseMass=body.mass, physicsClientId=world))
        inertia = moments_of_inertia(body)[0, 0] if i < places.rigid else body.mass
        pybullet.changeDynamics(bodies[-1], -1, linearDamping=0.0, angularDamping=0.0,
                                localInertiaDiagonal=(inertia,) * 3, maxJointVelocity=1e9,
                                physicsClientId=world)
        masses.append(body.mass)
        inertias.append(inertia)
    return world, bodies, masses, inertias


def put(pybullet, world, bodies, places, y):
    for i, body in enumerate(bodies):
        q, omega = (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        if i < places.rigid:
            q, omega = y[places.orientation(i)], y[places.angular_velocity(i)]
        pybullet.resetBasePositionAndOrientation(body, y[places.position(i)], [*q[1:], q[0]],
                                                 physicsClientId=world)
        pybullet.resetBaseVelocity(body, y[places.velocity(i)], omega, physicsClientId=world)


def get(pybullet, world, bodies, places, y):
    """Write the state of the world to y."""
    for i, body in enumerate(bodies):
        position, q = pybullet.getBasePositionAndOrientation(body, physicsClientId=world)
        velocity, omega = pybullet.getBaseVelocity(body, physicsClientId=world)
        y[places.position(i)], y[places.velocity(i)] = position, velocity
        if i < places.rigid:
            y[places.orientation(i)] = q[3], *q[:3]
            y[places.angular_velocity(i)] = omega
