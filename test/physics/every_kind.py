# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Compare the right-hand side with newton_euler.py for a scene with everything in it.

Prints, as JSON, the largest relative difference of each kind. Run with NUMBA_DISABLE_JIT=1: the
same source then takes no time to compile.
"""

import json

from dynsim_ros.physics.drive import Drive, initial_anchors
from dynsim_ros.physics.energies import energies
from dynsim_ros.physics.model import build_model
from dynsim_ros.physics.motion import rates
from dynsim_ros.physics.wrenches import wrenches
from dynsim_ros.scene import parse_scene
from dynsim_ros.simulation.layout import Layout
from newton_euler import NewtonEuler, rotation_of
import numpy as np
from random_states import difference, random_state
from scipy.spatial.transform import Rotation

ENDS = {'a1': 'anchor', 'a2': 'anchor', 'ball': 'rigid', 'crate': 'rigid', 'dot': 'particle',
        'dust': 'particle', 'die': 'rigid', 'potato': 'rigid'}
SCENE = """
gravity: 9.81
down: [0.1, -0.2, -1]
air: {linear_drag: 0.3, rotational_drag: 0.02, velocity: [1, 2, -1], angular_velocity: [3, 0, 1]}
anchors: {a1: {position: [0, 0, 2]}, a2: {position: [1, -1, 0], velocity: [0.3, 0.1, 0.7]}}
bodies:
  dot: {shape: particle, mass: 0.7}
  potato: {shape: rigid, mass: 1.1, inertia: [[2, 0.3, -0.1], [0.3, 1.5, 0.2], [-0.1, 0.2, 1]]}
  ball: {shape: sphere, mass: 1.3, radius: 0.2}
  dust: {shape: particle, mass: 0.1}
  crate: {shape: box, mass: 2, size: [0.3, 0.5, 0.9]}
  die: {shape: box, mass: 0.5, size: [0.4, 0.4, 0.4]}
  top: {shape: rigid, mass: 0.9, inertia: [0.2, 0.2, 0.3]}
springs:
"""


def every_spring():
    """Return YAML of a spring between every two ends but anchors, in all varieties."""
    lines, number = [], 0
    for start, start_kind in ENDS.items():
        for end, end_kind in ENDS.items():
            if start == end or start_kind == end_kind == 'anchor':
                continue
            number += 1
            line = f'  s{number}: {{from: {start}, to: {end}, stiffness: {10 + number}, '
            line += f'natural_length: {0.1 * (number % 5)}'
            if number % 2:
                line += f', damping: {0.1 * number}'
            if number % 3 and start_kind == 'rigid':
                line += f', from_offset: [0.1, {0.01 * number}, -0.2]'
            if number % 4 and end_kind == 'rigid':
                line += f', to_offset: [{0.01 * number}, -0.1, 0.3]'
            lines.append(line + '}')
    return '\n'.join(lines)


def quaternion_rate(q, omega):
    """Return dq/dt by a central difference of scipy's rotations."""
    h = 1e-5
    ahead, behind = (np.roll((Rotation.from_rotvec(s * h * omega) * rotation_of(q)).as_quat(), 1)
                     for s in (1, -1))
    return (ahead * np.sign(ahead @ q) - behind * np.sign(behind @ q)) / (2 * h)


def compare(scene, y, motion, random):
    """Return {kind: difference} for one state."""
    layout, model, t = Layout(scene), build_model(scene), 0.37
    anchors = initial_anchors(scene)
    pushes, given = np.zeros(layout.size), {}
    for body in ('dot', 'crate'):
        given[body] = random.normal(size=(2, 3)) * [[1], [body == 'crate']]
        pushes[layout.velocity(body)] = given[body][0]
        if layout.angular_velocity(body) is not None:
            pushes[layout.angular_velocity(body)] = given[body][1]
    reference = NewtonEuler(scene, given)
    out, parts = np.full(layout.size, np.nan), np.zeros((4, layout.size))
    rates(model, Drive(anchors, True, pushes, True), t, y, out)
    wrenches(model, anchors, t, y, parts)
    loads = reference.loads(t, reference.unpacked(reference.packed(motion)))
    found = {}
    for body, (linear, angular) in reference.accelerations(t, reference.packed(motion)).items():
        turning = layout.angular_velocity(body)
        sums = (parts.sum(axis=0) + pushes)
        found[body] = {'position': difference(out[layout.position(body)], motion[body][1]),
                       'velocity': difference(out[layout.velocity(body)], linear),
                       'force': difference(sums[layout.velocity(body)], loads[body][0])}
        if turning is not None:
            q = y[layout.orientation(body)]
            found[body] |= {
                'omega': difference(out[turning], angular),
                'moment': difference(sums[turning], loads[body][1]),
                'quaternion rate': difference(out[layout.orientation(body)],
                                              quaternion_rate(q, motion[body][3]))}
    # d(energy)/dt along the motion is all the power that the right-hand side counts as work;
    # the anchor at constant velocity moves on too
    h, energy = 1e-6, {}
    for sign in (1, -1):
        ahead = y + sign * h * out
        energy[sign] = sum(energies(model, anchors, t + sign * h, ahead))
    found['power'] = {'work': difference((energy[1] - energy[-1]) / (2 * h),
                                         out[layout.work].sum())}
    return found


def main():
    """Compare in some random states; print the largest difference of each kind."""
    scene = parse_scene(SCENE + every_spring())
    random = np.random.default_rng(11)
    worst = {}
    for _ in range(5):
        state = random_state(Layout(scene), random)
        for body, kinds in compare(scene, *state, random).items():
            for kind, value in kinds.items():
                worst[f'{body} {kind}'] = max(value, worst.get(f'{body} {kind}', 0.0))
    print(json.dumps({'springs': len(scene.springs), 'worst': worst}))


if __name__ == '__main__':
    main()
