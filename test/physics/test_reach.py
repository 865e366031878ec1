# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The vector of a spring that is kept beside the state, beside exact fractions."""

from fractions import Fraction

from dynsim_ros.physics.arms import arm_of_state, with_arm
from dynsim_ros.physics.drive import Drive
from dynsim_ros.physics.model import build_model
from dynsim_ros.physics.motion import accelerations
from dynsim_ros.physics.reach import put_reach, reach_of_state
from dynsim_ros.physics.state import ARM, EXCESS, initial_state, REACH, REACH_SIZE
from dynsim_ros.scene import Anchor, Scene, Sphere, Spring
import mpmath
import numpy as np
import pytest

MASS, NATURAL = 0.1, 0.74
# Far from the origin, and near its natural length.
POSITION, VELOCITY, TIME, WAY = (301.3, -250.1, 100.4), (0.2, -0.1, 0.3), 7.3, 0.02
ANCHOR = tuple(x + away - TIME * v
               for x, away, v in zip(POSITION, (-0.3, 0.4, 0.55), VELOCITY))
MOVED = (1.1e-3, -2.3e-4, 3.7e-5)


def scene_of(turned, radius=0.05, position=POSITION):
    body = Sphere(name='ball', mass=MASS, radius=radius, position=position)
    ends = ('hand', 'ball')
    from_, to = reversed(ends) if turned else ends
    spring = Spring(name='spring', from_=from_, to=to, stiffness=1e6, natural_length=NATURAL)
    anchor = Anchor(name='hand', position=ANCHOR, velocity=VELOCITY)
    return Scene(bodies=(body,), springs=(spring,), anchors=(anchor,))


def moved_state(model, y, drive):
    """Return a state some way after the one that the reach is from, and that way."""
    arm = arm_of_state(model, y)
    here = np.zeros(REACH + REACH_SIZE)
    here[:3] = MOVED
    here[ARM:REACH] = 1e-4, 2e-4, -1e-5
    state = np.concatenate([y, np.zeros(len(here) - len(y))]) + here
    put_reach(reach_of_state(model, drive, TIME, y, arm), WAY, here, state)
    return state, here, arm


def exact_reach(y, here, arm):
    return [Fraction(y[i]) + Fraction(here[i]) + Fraction(arm[i]) + Fraction(here[ARM + i])
            - Fraction(ANCHOR[i]) - (Fraction(TIME) + Fraction(WAY)) * Fraction(VELOCITY[i])
            for i in range(3)]


@pytest.mark.parametrize('turned', [False, True], ids=['from the anchor', 'to the anchor'])
def test_reach_and_excess_have_no_rounding_of_positions(turned):
    scene = scene_of(turned)
    model = build_model(scene)
    y = initial_state(scene, model)
    state, here, arm = moved_state(model, y, drive := Drive(
        np.array([[*ANCHOR, *VELOCITY]]), True, None, None))
    exact = exact_reach(y, here, arm)
    np.testing.assert_allclose(state[REACH:REACH + 3], [float(r) for r in exact], rtol=0,
                               atol=3e-16)
    excess = sum(r * r for r in exact) - Fraction(NATURAL) ** 2
    assert abs(state[REACH + EXCESS] - float(excess)) < 2e-18 + 3e-16 * abs(float(excess))
    check_force(model, drive, state, exact)


def check_force(model, drive, state, exact):
    """Check the acceleration: what of it is left by rounding is relative to the extension."""
    out = np.zeros(len(state))
    accelerations(with_arm(model), drive, TIME + WAY, state, out)
    with mpmath.workdps(40):
        r = [mpmath.mpf(x.numerator) / x.denominator for x in exact]
        length = mpmath.sqrt(sum(x * x for x in r))
        expected = [float(-1e6 * (1 - NATURAL / length) * x / MASS) for x in r]
    np.testing.assert_allclose(out[3:6], expected, rtol=1e-13)


def test_a_spring_that_is_drawn_to_a_point_has_a_finite_force():
    scene = scene_of(False, 0.125, (0.25, 0.0, -0.125))
    model = build_model(scene)
    drive = Drive(np.zeros((1, 6)), None, None, None)
    y = initial_state(scene, model)
    here = np.zeros(REACH + REACH_SIZE)
    here[0] = -0.25
    arm = arm_of_state(model, y)
    state = np.concatenate([y, arm, np.zeros(len(here) - ARM - 3)]) + here
    put_reach(reach_of_state(model, drive, 0.0, y, arm), 0.0, here, state)
    assert not state[REACH:REACH + 3].any()
    out = np.zeros(len(state))
    accelerations(with_arm(model), drive, 0.0, state, out)
    assert not out[3:6].any()
