# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
What a geometric method promises: the way back is the way there, energy stays within bounds.

For a sphere and for a box, each on a spring that has a moment about the centre of mass.
"""

from dataclasses import replace

from by_hand import ByHand
from dynsim_ros.integrators import leapfrog
from dynsim_ros.simulation import Propagator
from dynsim_ros.simulation.layout import Layout
from newton_euler import inertia_matrix, rotation_of
import numpy as np
import pytest
from references import load
from scipy.spatial.transform import Rotation


def without_damper(scene):
    return replace(scene, springs=tuple(replace(spring, damping=None)
                                        for spring in scene.springs))


SCENES = {'sphere': load('S2_without_losses')[0],
          'box': without_damper(load('box_by_its_corner')[0])}
SHAPES = pytest.mark.parametrize('shape', SCENES)


def energy_and_momentum(scene, states):
    """Return energies, and angular momenta about the vertical through the anchor."""
    body, spring, anchor = scene.bodies[0], scene.springs[0], scene.anchors[0]
    offset = (0, 0, body.radius) if spring.to_offset is None else spring.to_offset
    r, v, omega = states[:, :3], states[:, 3:6], states[:, 10:13]
    turn = rotation_of(states[:, 6:10])
    spin = turn.apply(turn.inv().apply(omega) @ inertia_matrix(body))
    stretch = (np.linalg.norm(r + turn.apply(offset) - anchor.position, axis=1)
               - spring.natural_length)
    energy = (body.mass * (v ** 2).sum(axis=1) + (omega * spin).sum(axis=1)
              + spring.stiffness * stretch ** 2) / 2 + body.mass * scene.gravity * r[:, 2]
    return energy, (body.mass * np.cross(r - anchor.position, v) + spin)[:, 2]


def swinging_gently(scene):
    """
    Return the scene with its body near the place where it hangs at rest.

    As it stands the box's motion is chaotic: a difference of 1e-14 at the start decides how its
    energy error wanders, by up to a quarter of its range in a million steps.
    """
    body, spring, anchor = scene.bodies[0], scene.springs[0], scene.anchors[0]
    upright, _ = Rotation.align_vectors([[0, 0, 1]], [spring.to_offset])
    turn = Rotation.from_rotvec([0.06, 0.04, 0]) * upright
    length = spring.natural_length + body.mass * scene.gravity / spring.stiffness
    x, y, z, w = turn.as_quat()
    position = anchor.position - np.array([0, 0, length]) - turn.apply(spring.to_offset)
    return replace(scene, bodies=(replace(
        body, position=tuple(position), orientation=(w, x, y, z),
        angular_velocity=tuple(0.2 * np.array(body.angular_velocity))),))


def turned_back(scene, state):
    """Return a state with all velocities reversed."""
    state, layout = state.copy(), Layout(scene)
    for body in layout.bodies:
        state[layout.velocity(body)] *= -1
        if layout.angular_velocity(body) is not None:
            state[layout.angular_velocity(body)] *= -1
    return state


@SHAPES
def test_the_way_back_is_the_way_there(shape):
    scene = SCENES[shape]
    hand = ByHand(scene, 'leapfrog')
    state = hand.start.copy()
    leapfrog.advance(hand.model, hand.drive, 0, 1_000_000, 2000, state, hand.memory)
    assert np.abs(state - hand.start).max() > 0.5
    state = turned_back(scene, state)
    leapfrog.advance(hand.model, hand.drive, 0, 1_000_000, 2000, state, hand.memory)
    np.testing.assert_allclose(turned_back(scene, state), hand.start, rtol=0, atol=1e-10)


def test_the_way_back_of_several_bodies():
    scene = without_damper(load('pulling_at_each_other')[0])
    hand = ByHand(scene, 'leapfrog')
    end = hand.run(0.5, 100)[-1]
    assert np.abs(end - hand.start).max() > 0.5
    back = hand.run(0.5, 100, turned_back(scene, end))[-1]
    np.testing.assert_allclose(turned_back(scene, back), hand.start, rtol=0, atol=1e-12)


@SHAPES
def test_energy_stays_within_bounds_for_a_million_steps(shape):
    scene = SCENES[shape]
    off, momentum = long_run(scene)
    assert np.abs(off).max() < 1e-4
    np.testing.assert_allclose(momentum, momentum[0], rtol=0, atol=1e-9)
    # no drift: the last third is as the first
    first, _, last = np.array_split(off if shape == 'sphere'
                                    else long_run(swinging_gently(scene))[0], 3)
    assert abs(np.mean(last) - np.mean(first)) < 0.05 * np.ptp(off)


def long_run(scene):
    """Return relative energy errors, and momenta, in a million steps."""
    states = Propagator(scene, integrator='leapfrog', step=1e-3).samples(1000.0, 10.0)
    energy, momentum = energy_and_momentum(scene, states)
    # of the kinetic energy that comes and goes, not of an energy whose zero is anywhere
    scale = 0.5 * scene.bodies[0].mass * (states[:, 3:6] ** 2).sum(axis=1).max()
    return (energy - energy[0]) / scale, momentum
