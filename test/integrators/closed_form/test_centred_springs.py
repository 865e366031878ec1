# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A particle on springs of natural length zero, against matrix exponentials of many digits."""

from dynsim_ros.integrators.closed_form.centred_springs import (centre_of_springs,
                                                                on_centred_springs)
from dynsim_ros.scene import load_scene, parse_scene, scene_to_yaml
from integrators.closed_form.exact import error, linear_motion
import mpmath as mp
from newton_euler import NewtonEuler
import numpy as np
from plain import compiled_and_plain
import pytest

R, V, G, WIND = (0.3, -2.0, 1.2), (1.0, 0.5, -3.0), (0.3, -0.2, -9.81), (3.0, -1.0, 0.1)
CENTRE, CENTRE_VELOCITY = (0.0, 0.1, 2.0), (0.2, -0.7, 0.05)
MASS = 0.7


def exact(t, stiffness, drag, moving, acceleration, wind):
    """Return position and velocity in the frame of the centre, and back in world."""
    with mp.workdps(60):
        square, resistance = mp.mpf(stiffness) / MASS, mp.mpf(drag or 0) / MASS
        parts = []
        for r, v, c, u, a, w in zip(R, V, CENTRE, moving or (0, 0, 0), acceleration or (0, 0, 0),
                                    wind or (0, 0, 0)):
            y, rate = linear_motion(t, mp.mpf(r) - c, mp.mpf(v) - u, resistance, square,
                                    a + resistance * (mp.mpf(w) - u))
            parts.append((y + c + mp.mpf(u) * t, rate + u))
    return zip(*parts)


@compiled_and_plain(on_centred_springs)
@pytest.mark.parametrize('moving, acceleration, drag, wind', [
    (None, None, None, None), (CENTRE_VELOCITY, G, None, None), (None, G, 0.3, None),
    (CENTRE_VELOCITY, G, 0.3, WIND), (CENTRE_VELOCITY, G, 1e-9, WIND),
    (CENTRE_VELOCITY, G, 2 * 0.7 * 5.0, WIND), (CENTRE_VELOCITY, G, 400.0, WIND)])
def test_motion(formula, moving, acceleration, drag, wind):
    for stiffness in (1e-12, 0.02, 0.7 * 25.0, 3e4):
        for t in (0.0, 0.01, 0.8, 12.0):
            position, velocity = exact(t, stiffness, drag, moving, acceleration, wind)
            found = formula(t, R, V, MASS, stiffness, CENTRE, moving, acceleration, drag, wind)
            rate = np.sqrt(stiffness / MASS)
            assert error(found[0], position) < 2e-15 * (1 + rate * t)
            assert error(found[1], velocity, 1 + rate) < 2e-15 * (1 + rate * t)


def test_two_motions_are_one():
    more = MASS, 40.0, CENTRE, None, G, 0.3, WIND
    middle = on_centred_springs(0.7, R, V, *more)
    np.testing.assert_allclose(on_centred_springs(1.1, *middle, *more),
                               on_centred_springs(0.7 + 1.1, R, V, *more), atol=1e-13)


def scene_of_three_springs():
    text = scene_to_yaml(load_scene('particle_on_spring'))
    head = text[:text.index('anchors:')]
    return parse_scene(head + """
air: {linear_drag: 0.4, velocity: [1, -2, 0.5]}
anchors:
  one: {position: [0, 0, 2], velocity: [0.1, 0, 0]}
  two: {position: [1, 0, 0], velocity: [0, 0.3, 0]}
  three: {position: [0, -1, 1]}
bodies:
  particle: {shape: particle, mass: 0.7, position: [0.3, -2, 1.2], velocity: [1, 0.5, -3]}
springs:
  a: {from: one, to: particle, stiffness: 20, natural_length: 0}
  b: {from: particle, to: two, stiffness: 5, natural_length: 0}
  c: {from: three, to: particle, stiffness: 11, natural_length: 0}
""")


def test_three_springs_of_a_scene_against_the_equations_of_motion_solved_by_scipy():
    scene = scene_of_three_springs()
    stiffnesses = [spring.stiffness for spring in scene.springs]
    anchors = {anchor.name: anchor for anchor in scene.anchors}
    ends = [anchors[name] for name in ('one', 'two', 'three')]
    stiffness, centre = centre_of_springs(stiffnesses, [anchor.position for anchor in ends])
    moving = centre_of_springs(stiffnesses, [anchor.velocity for anchor in ends])[1]
    found = on_centred_springs(3.0, R, V, MASS, stiffness, centre, moving, (0.0, 0.0, -9.81), 0.4,
                               scene.air.velocity)
    r, v, _, _ = NewtonEuler(scene).solve([3.0])[0]['particle']
    # V and R are those of the scene
    np.testing.assert_allclose(found[0], r, atol=1e-11)
    np.testing.assert_allclose(found[1], v, atol=1e-11)
