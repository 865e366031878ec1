# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Spring and damper against the closed forms of the damped and of the plane oscillator."""

from by_hand import nothing_compiled
from dynsim_ros.scene import load_scene, parse_scene, scene_to_yaml, with_values
from dynsim_ros.simulation import Simulator
import numpy as np
import pytest

STIFFNESS, MASS = 50.0, 2.0
OMEGA = np.sqrt(STIFFNESS / MASS)
by_both_methods = pytest.mark.parametrize('method', [
    {'integrator': 'rk4', 'step': 5e-5}, {'integrator': 'auto', 'tolerance': 1e-12}],
    ids=['rk4', 'auto'])
# Where any step is exact, a run takes less time than compiling what nobody else needs.
in_plain_python = pytest.mark.parametrize('method', [
    {'integrator': 'rk4', 'step': 1e-3}, {'integrator': 'auto', 'tolerance': 1e-12}],
    ids=['rk4', 'auto'])


def hung_at_its_centre(**values):
    """Return a scene of the same kind as sphere_on_spring; the spring holds the centre."""
    text = scene_to_yaml(load_scene('sphere_on_spring'))
    text = text.replace('to: sphere', 'to: sphere, to_offset: [0, 0, 0]')
    return with_values(parse_scene(text), {
        'gravity': 0, 'air.linear_drag': 0, 'air.rotational_drag': 0, 'spring.damping': 0,
        'spring.stiffness': STIFFNESS, 'sphere.mass': MASS, 'hand.position': (0, 0, 0),
        **{name.replace('__', '.'): value for name, value in values.items()}})


def damped(x, v, damping, t):
    """Return position and velocity of m x'' + b x' + k x = 0."""
    roots = np.roots([MASS, damping, STIFFNESS]).astype(complex)
    if damping ** 2 == 4 * STIFFNESS * MASS:
        rate = -damping / (2 * MASS)
        slope = v - rate * x
        decay = np.exp(rate * t)
        return (x + slope * t) * decay, (slope + rate * (x + slope * t)) * decay
    weights = np.linalg.solve([[1, 1], roots], [x, v])
    terms = weights[:, None] * np.exp(roots[:, None] * t)
    return terms.sum(axis=0).real, (roots[:, None] * terms).sum(axis=0).real


@by_both_methods
@pytest.mark.parametrize('damping', [0.0, 4.0, 20.0, 50.0],
                         ids=['undamped', 'underdamped', 'critical', 'overdamped'])
def test_damped_oscillator(damping, method):
    assert (damping ** 2 > 4 * STIFFNESS * MASS) is (damping == 50.0)
    # it hangs: at rest the length is the natural length and m g / k
    natural, rest = 1.0, 1.0 + MASS * 9.81 / STIFFNESS
    scene = hung_at_its_centre(gravity=9.81, spring__damping=damping,
                               spring__natural_length=natural,
                               sphere__position=(0, 0, -rest - 0.2), sphere__velocity=(0, 0, 1))
    run = Simulator(scene, rate=50, **method).run(3.0)
    x, v = damped(-0.2, 1.0, damping, run.time)
    np.testing.assert_allclose(run.position('sphere')[:, 2], x - rest, atol=1e-12)
    np.testing.assert_allclose(run.velocity('sphere')[:, 2], v, atol=5e-12)
    np.testing.assert_array_equal(run.position('sphere')[:, :2], 0.0)


@by_both_methods
def test_zero_length_spring_in_the_plane_runs_on_an_ellipse(method):
    r, v = np.array([0.4, 0.0, 0.1]), np.array([0.3, 1.5, -0.2])
    scene = hung_at_its_centre(spring__natural_length=0, sphere__position=r, sphere__velocity=v)
    run = Simulator(scene, rate=50, **method).run(3.0)
    phase = OMEGA * run.time[:, None]
    np.testing.assert_allclose(run.position('sphere'),
                               r * np.cos(phase) + v / OMEGA * np.sin(phase), atol=1e-12)


@by_both_methods
def test_zero_length_spring_through_length_zero(method):
    """The sphere passes through the anchor twice a period, once exactly."""
    scene = hung_at_its_centre(spring__natural_length=0, sphere__position=(0, 0, 0),
                               sphere__velocity=(0, 0, 2))
    run = Simulator(scene, rate=50, **method).run(3.0)
    np.testing.assert_allclose(run.position('sphere')[:, 2],
                               2 / OMEGA * np.sin(OMEGA * run.time), atol=1e-12)


@in_plain_python
def test_body_at_the_anchor_of_a_spring_of_some_length_stays_finite(method):
    """There the direction of the force is undefined; with L + epsilon there is no force."""
    scene = hung_at_its_centre(spring__natural_length=0.5, spring__damping=1,
                               sphere__position=(0, 0, 0), sphere__velocity=(0, 0, 0))
    with nothing_compiled():
        run = Simulator(scene, **method).run(0.1)
    np.testing.assert_array_equal(run.position('sphere'), 0.0)
    assert run.snapshots[0].energy.spring == pytest.approx(0.5 * STIFFNESS * 0.25)


@in_plain_python
def test_oscillator_does_not_turn_when_held_at_its_centre(method):
    scene = hung_at_its_centre(sphere__position=(0.3, 0, -1))
    with nothing_compiled():
        run = Simulator(scene, **method).run(1.0)
    np.testing.assert_array_equal(run.angular_velocity('sphere'),
                                  np.tile(run.angular_velocity('sphere')[0], (101, 1)))
