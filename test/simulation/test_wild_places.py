# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Places where formulas divide by zero or motions know no scale: finite, bounded work, or one line.

Against closed forms where there are any: through the anchor a spring of natural length pushes to
the other side at once, so that the motion is of one oscillation on each side of it.
"""

from by_hand import nothing_compiled
from dynsim_ros.integrators import adaptive_steps
from dynsim_ros.scene import parse_scene, with_values
from dynsim_ros.simulation import DivergenceError, MoveAnchor, Propagator, SetValues, Simulator
from newton_euler import NewtonEuler
import numpy as np
import pytest
from references import load
from scipy.optimize import brentq
from simulated import samples

PARTICLE, SPHERE = load('S1')[0], load('S2')[0]
METHODS = pytest.mark.parametrize('method', ['extrapolation', 'dop853', 'radau', 'auto'])
MASS, STIFFNESS, NATURAL_LENGTH, GRAVITY = 1.0, 100.0, 0.5, 9.81


@pytest.fixture
def plain():
    with nothing_compiled():
        yield


def dropped(x, z):
    """Return the scene of a particle at rest at x, z from its anchor."""
    return with_values(PARTICLE, {'dot.position': (x, 0, z), 'dot.velocity': (0, 0, 0),
                                  'hand.position': (0, 0, 0)})


def on_a_line(z, v, duration):
    """Return height and speed after a duration: oscillations about a place on each side."""
    rate, side = np.sqrt(STIFFNESS / MASS), 1.0 if z > 0 else -1.0
    while True:
        middle = side * NATURAL_LENGTH - GRAVITY * MASS / STIFFNESS
        reach, phase = np.hypot(z - middle, v / rate), np.arctan2(-v / rate, z - middle)

        def height(t, middle=middle, reach=reach, phase=phase):
            return middle + reach * np.cos(rate * t + phase)
        times = np.linspace(0.0, 2 * np.pi / rate, 1001)[1:]
        across = np.flatnonzero(height(times) * side < 0)
        crossing = np.inf
        if len(across):
            crossing = brentq(height, times[across[0] - 1], times[across[0]], xtol=1e-15)
        if crossing > duration:
            return height(duration), -reach * rate * np.sin(rate * duration + phase)
        z, v, side = 0.0, -reach * rate * np.sin(rate * crossing + phase), -side
        duration -= crossing


@METHODS
def test_through_the_anchor(plain, method):
    """Eight times in two seconds; each time the force jumps, which costs digits."""
    end = Propagator(dropped(0, 1.5), integrator=method, tolerance=1e-9).end_state(2.0)
    z, v = on_a_line(1.5, 0.0, 2.0)
    np.testing.assert_allclose(end[[2, 5]], (z, v), rtol=0, atol=1e-4)
    np.testing.assert_array_equal(end[[0, 1, 3, 4]], 0)


@METHODS
def test_past_the_anchor_at_a_hair(plain, method):
    propagator = Propagator(dropped(1e-9, 1.5), integrator=method, tolerance=1e-9)
    end = propagator.end_state(0.5)
    energy = (MASS * end[3:6] @ end[3:6] / 2 + MASS * GRAVITY * end[2]
              + STIFFNESS * (np.linalg.norm(end[:3]) - NATURAL_LENGTH) ** 2 / 2)
    assert energy == pytest.approx(MASS * GRAVITY * 1.5 + STIFFNESS / 2, abs=1e-4)
    assert sum(propagator.counts.values()) < 20_000


@METHODS
def test_off_from_the_anchor(plain, method):
    """At the anchor a spring pulls nowhere; gravity says to which side it goes."""
    end = Propagator(dropped(0, 0), integrator=method, tolerance=1e-9).end_state(0.5)
    z, v = on_a_line(-1e-300, 0.0, 0.5)
    np.testing.assert_allclose(end[[2, 5]], (z, v), rtol=0, atol=1e-6)


@METHODS
@pytest.mark.parametrize('distance', [0.0, 5e-324, 1e-310, 1e-160, 1e-30, 1e-20, 1e-12])
def test_at_no_distance_without_weight(plain, method, distance):
    """It stays where nothing pushes, else it is pushed away and swings about the length."""
    scene = with_values(dropped(distance, 0), {'gravity': 0})
    propagator = Propagator(scene, integrator=method, tolerance=1e-9)
    end = propagator.end_state(0.5)
    assert np.isfinite(end).all()
    # Within epsilon of the anchor, 2.7e-20 m, a spring has no direction: either way is right.
    side = -1 if distance == 1e-30 and end[0] < 0 else 1
    assert 0 <= side * end[0] <= 2 * NATURAL_LENGTH + 1e-9
    energy = MASS * end[3] ** 2 / 2 + STIFFNESS * (abs(end[0]) - NATURAL_LENGTH) ** 2 / 2
    assert energy == pytest.approx(STIFFNESS * NATURAL_LENGTH ** 2 / 2, rel=1e-6)
    np.testing.assert_array_equal(end[[1, 2, 4, 5]], 0)
    assert sum(propagator.counts.values()) < 10_000


@METHODS
def test_masses_a_thousand_million_apart(plain, method):
    scene = parse_scene("""
        bodies:
          light: {shape: particle, mass: 0.001, position: [0.9, 0, 0]}
          heavy: {shape: particle, mass: 1.0e6}
        springs: {spring: {from: heavy, to: light, stiffness: 0.1, natural_length: 0.5}}
    """)
    light, heavy = Propagator(scene, integrator=method).end_state(2.0)[:6].reshape(2, 3)
    rate = np.sqrt(0.1 * (1 / 0.001 + 1 / 1e6))
    assert light[0] - heavy[0] == pytest.approx(0.5 + 0.4 * np.cos(2 * rate), abs=1e-9)
    # they pull at each other with the same force
    assert 0.001 * (light[0] - 0.9) + 1e6 * heavy[0] == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize('spin', [1e3, 1e5])
@pytest.mark.parametrize('method', ['extrapolation', 'auto'])
def test_huge_spin(method, spin):
    scene = with_values(SPHERE, {'ball.angular_velocity': (0, 0.6 * spin, 0.8 * spin)})
    end = samples(scene, 100 / spin, spin / 100, integrator=method)[0][-1]
    r, v, _, omega = NewtonEuler(scene).solve([100 / spin])[0]['ball']
    np.testing.assert_allclose(end[:3], r, atol=1e-9)
    np.testing.assert_allclose(end[3:6], v, atol=1e-8)
    np.testing.assert_allclose(end[10:13] / spin, omega / spin, atol=1e-9)


@pytest.mark.parametrize('distance', [10.0, 1e3, 1e5])
@pytest.mark.parametrize('scene', [PARTICLE, SPHERE], ids=['particle', 'sphere'])
def test_anchor_that_is_suddenly_elsewhere(scene, distance):
    simulator = Simulator(scene, tolerance=1e-6)
    simulator.advance(20_000_000)
    simulator.apply(MoveAnchor('hand', (distance, 0, 2)))
    simulator.advance(10_000_000)
    energy = simulator.snapshot().energy
    assert energy.work['anchor'] > 10 * distance
    assert abs(energy.imbalance) < 1e-6 * energy.work['anchor']
    assert simulator.snapshot().state[3] > 0.5 * distance * STIFFNESS * 0.01


SWITCHED = [{'spring.damping': 1e6}, {'ball.radius': 1e-4}, {'ball.mass': 1e-3},
            {'air.linear_drag': 1e6}, {'spring.natural_length': 1e3}, {'spring.stiffness': 1e7}]


@pytest.mark.parametrize('values', SWITCHED, ids=lambda values: next(iter(values)))
def test_parameters_switched_in_mid_run(values):
    """The energy that a change gives or takes is not counted; all that follows is."""
    simulator = Simulator(SPHERE, tolerance=1e-6)
    simulator.advance(20_000_000)
    simulator.apply(SetValues(values))
    before = simulator.snapshot()
    simulator.advance(10_000_000)
    after = simulator.snapshot()
    assert np.isfinite(after.state).all()
    assert (after.state != before.state).any()
    scale = max(1.0, after.energy.kinetic, before.energy.spring)
    assert abs(after.energy.imbalance - before.energy.imbalance) < 1e-5 * scale


def test_work_is_bounded_and_the_reason_says_how(monkeypatch):
    """As many attempts as are allowed and no more, where a million times more were needed."""
    scene = with_values(SPHERE, {'ball.mass': 1e-6, 'spring.stiffness': 1e12})
    monkeypatch.setattr(adaptive_steps.Walk, 'budget', 50_000)
    simulator = Simulator(scene, integrator='radau', tolerance=1e-6, rate=1.0)
    with pytest.raises(DivergenceError) as caught:
        simulator.advance_tick()
    reason = str(caught.value)
    assert '\n' not in reason
    assert '50000 steps in one go did not suffice; the last ones were ' in reason
    assert 'use a larger tolerance than 1e-06, a softer spring, or more mass' in reason
    assert sum(simulator.counts) == 50_000


@pytest.mark.parametrize('method', ['extrapolation', 'auto', 'radau', 'stiff', 'dop853'])
def test_a_refused_run_stands_at_its_last_state(plain, monkeypatch, method):
    scene = with_values(PARTICLE, {'dot.mass': 1e-6, 'spring.stiffness': 1e12})
    monkeypatch.setattr(adaptive_steps.Walk, 'budget', 50)
    simulator = Simulator(scene, integrator=method, tolerance=1e-6)
    for _ in range(2):
        with pytest.raises(DivergenceError) as caught:
            simulator.advance_tick()
        reason = str(caught.value)
        assert reason.startswith('the motion cannot be computed between 0 s and 0.01 s of '
                                 'simulated time: 50 steps in one go did not suffice; ')
        assert reason.endswith('; the state of 0 s is kept')
        assert '\n' not in reason
        assert simulator.snapshot().time_ns == 0
