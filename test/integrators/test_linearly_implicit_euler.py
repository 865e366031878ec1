# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Linearly implicit Euler on springs that are far too stiff for its step."""

import math

from dynsim_ros.scene import Anchor, Particle, Scene, Spring
from dynsim_ros.simulation import Propagator
import pytest
from references import load

METHOD = 'linearly_implicit_euler'


def end_of(stiffness, damping, step, duration=0.1):
    """Return (position, velocity) along x of a particle of 1 kg on a spring without length."""
    scene = Scene(
        bodies=(Particle(name='dot', mass=1.0, position=(1.0, 0.0, 0.0)),),
        anchors=(Anchor(name='wall', position=(0.0, 0.0, 0.0)),),
        springs=(Spring(name='spring', from_='wall', to='dot', stiffness=stiffness,
                        damping=damping, natural_length=0.5),))
    state = Propagator(scene, integrator=METHOD, step=step).end_state(duration)
    return state[0], state[3]


@pytest.mark.parametrize('damping', [0.0, 1.0, 1e3])
def test_steps_are_those_of_the_method_written_out(damping):
    # x' = v, v' = -k (x - 1/2) - b v: (1 + h b + h^2 k) v_new = v - h k (x - 1/2)
    stiffness, h, x, v = 1e5, 1e-2, 1.0, 0.0
    for _ in range(10):
        v = (v - h * stiffness * (x - 0.5)) / (1.0 + h * damping + h * h * stiffness)
        x += h * v
    assert end_of(stiffness, damping, h) == pytest.approx((x, v), rel=1e-12)


@pytest.mark.parametrize('stiffness', [1e6, 1e9, 1e12])
def test_what_is_too_fast_comes_to_rest(stiffness):
    # each step leaves 1 / (1 + h^2 k) of the speed at most, and of the displacement its root
    position, velocity = end_of(stiffness, 0.0, 1e-2)
    left = (1.0 + 1e-4 * stiffness) ** -0.5
    assert abs(position - 0.5) <= 0.5 * left ** 9 + 1e-12
    assert abs(velocity) <= math.sqrt(stiffness) * left ** 9 + 1e-9


@pytest.mark.parametrize('name, error', [('S3q', 0.01), ('S3q8', 0.01)])
def test_the_slow_motion_is_followed(name, error):
    scene, times, motions = load(name)
    state = Propagator(scene, integrator=METHOD, step=1e-3).end_state(times[-1])
    (motion,) = motions[-1].values()
    assert state[:3] == pytest.approx(motion[0], abs=error)
