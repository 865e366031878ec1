# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
PyBullet on a sphere on a spring-damper in air, without compiling anything for the scene.

It has no spring between points: the forces, and the moments about the centre, are applied from
outside at every step, as in peers/pybullet.py, whose world this is.
"""

import math

import numpy as np
from peers.pybullet import get, make_world, put
from quaternions import rotated
from states import initial, Places

# A step takes 20 us: more would take longer than a cell may.
MOST_STEPS = 20_000


def end_state(case, step):
    """Return the state after a case's duration."""
    import pybullet

    count = round(case.duration / step)
    if count > MOST_STEPS:
        raise ValueError(f'{count} steps, driven from Python, take too long')
    scene, places = case.scene, Places(case.scene)
    world, bodies, _, _ = make_world(pybullet, scene, places, step)
    try:
        y = initial(scene)
        put(pybullet, world, bodies, places, y)
        for _ in range(count):
            get(pybullet, world, bodies, places, y)
            if not np.isfinite(y).all():
                break
            force, moment = acting(scene, places, y)
            pybullet.applyExternalForce(bodies[0], -1, force, y[places.position(0)],
                                        pybullet.WORLD_FRAME, physicsClientId=world)
            pybullet.applyExternalTorque(bodies[0], -1, moment, pybullet.WORLD_FRAME,
                                         physicsClientId=world)
            pybullet.stepSimulation(physicsClientId=world)
        get(pybullet, world, bodies, places, y)
    finally:
        pybullet.disconnect(physicsClientId=world)
    return y


def acting(scene, places, y):
    """Return the force [N] and the moment about the centre [N m] on the sphere, in world."""
    body, spring, air = scene.bodies[0], scene.springs[0], scene.air
    x, v, omega = y[places.position(0)], y[places.velocity(0)], y[places.angular_velocity(0)]
    arm = rotated(y[places.orientation(0)], np.array(body.default_offset))
    line = x + arm - np.array(scene.anchors[0].position)
    length = math.sqrt(line @ line)
    along = line / length
    rate = along @ (v + np.cross(omega, arm))
    pull = spring.stiffness * (length - spring.natural_length) + (spring.damping or 0.0) * rate
    weight = body.mass * scene.gravity * np.array(scene.down)
    return (weight - pull * along - air.linear_drag * v,
            np.cross(arm, -pull * along) - air.rotational_drag * omega)
