# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The vector of a spring that is kept beside the state, beside exact fractions."""

from fractions import Fraction

from dynsim_ros.physics.arms import arm_of_state, with_arm
from dynsim_ros.physics.drive import Drive
from dynsim_ros.physics.model import build_model
from dynsim_ros.physics.motion import accelerations
from dynsim_ros.physics.reach import put_reach, reach_of_state
from dynsim_ros.physics.state import ARM, CORRECTION, EXCESS, initial_state, REACH
from dynsim_ros.scene import Anchor, Particle, Scene, Sphere, Spring
import mpmath
import numpy as np
import pytest

NATURAL = 0.74
# Far from the origin, and near its natural length.
POSITION, VELOCITY, TIME, WAY = (301.3, -250.1, 100.4), (0.2, -0.1, 0.3), 7.3, 0.02
ANCHOR = tuple(x + away - TIME * v
               for x, away, v in zip(POSITION, (-0.3, 0.4, 0.55), VELOCITY))
MOVED = (1.1e-3, -2.3e-4, 3.7e-5)


def scene_of(body, turned):
    ends = ('hand', body.name)
    from_, to = reversed(ends) if turned else ends
    spring = Spring(name='spring', from_=from_, to=to, stiffness=1e6, natural_length=NATURAL)
    anchor = Anchor(name='hand', position=ANCHOR, velocity=VELOCITY)
    return Scene(bodies=(body,), springs=(spring,), anchors=(anchor,))


BODIES = (Particle(name='ball', mass=0.1, position=POSITION),
          Sphere(name='ball', mass=0.1, radius=0.05, position=POSITION))


def moved_state(model, y, drive):
    """Return a state some way after the one that the reach is from, and that way."""
    arm = arm_of_state(model, y)
    here = np.zeros(CORRECTION + 1)
    here[:3] = MOVED
    if arm is not None:
        here[ARM:REACH] = 1e-4, 2e-4, -1e-5
    state = np.concatenate([y, np.zeros(len(here) - len(y))]) + here
    put_reach(reach_of_state(model, drive, TIME, y, arm), arm, WAY, here, state)
    return state, here, arm


def exact_reach(y, here, arm):
    arm = (0.0, 0.0, 0.0) if arm is None else arm
    return [Fraction(y[i]) + Fraction(here[i]) + Fraction(arm[i]) + Fraction(here[ARM + i])
            - Fraction(ANCHOR[i]) - (Fraction(TIME) + Fraction(WAY)) * Fraction(VELOCITY[i])
            for i in range(3)]


@pytest.mark.parametrize('turned', [False, True], ids=['from the anchor', 'to the anchor'])
@pytest.mark.parametrize('body', BODIES, ids=['particle', 'sphere'])
def test_reach_and_excess_have_no_rounding_of_positions(body, turned):
    scene = scene_of(body, turned)
    model = build_model(scene)
    y = initial_state(scene, model)
    y = np.concatenate([y, np.zeros(ARM - len(y))])
    state, here, arm = moved_state(model, y, drive := Drive(
        np.array([[*ANCHOR, *VELOCITY]]), True, None, None))
    exact = exact_reach(y, here, arm)
    np.testing.assert_allclose(state[REACH:EXCESS], [float(r) for r in exact], rtol=0, atol=3e-16)
    excess = sum(r * r for r in exact) - Fraction(NATURAL) ** 2
    assert abs(state[EXCESS] - float(excess)) < 2e-18 + 3e-16 * abs(float(excess))
    force(model, drive, state, exact, body.mass)


def force(model, drive, state, exact, mass):
    """Check the acceleration: what of it is left by rounding is relative to the extension."""
    out = np.zeros(len(state))
    accelerations(with_arm(model), drive, TIME + WAY, state, out)
    with mpmath.workdps(40):
        r = [mpmath.mpf(x.numerator) / x.denominator for x in exact]
        length = mpmath.sqrt(sum(x * x for x in r))
        expected = [float(-1e6 * (1 - NATURAL / length) * x / mass) for x in r]
    np.testing.assert_allclose(out[3:6], expected, rtol=1e-13)


def test_a_spring_that_is_drawn_to_a_point_has_a_finite_force():
    scene = scene_of(Particle(name='ball', mass=0.1, position=(0.3, 0.0, 0.0)), False)
    model = build_model(scene)
    drive = Drive(np.zeros((1, 6)), None, None, None)
    y = np.concatenate([initial_state(scene, model), np.zeros(ARM)])[:ARM]
    here = np.zeros(CORRECTION + 1)
    here[0] = -0.3
    state = np.concatenate([y, np.zeros(len(here) - len(y))]) + here
    put_reach(reach_of_state(model, drive, 0.0, y, None), None, 0.0, here, state)
    assert not state[REACH:EXCESS].any()
    out = np.zeros(len(state))
    accelerations(with_arm(model), drive, 0.0, state, out)
    assert not out[3:6].any()
