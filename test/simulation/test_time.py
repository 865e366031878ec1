# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Time is an integer number of nanoseconds; who samples a run changes no bit of it."""

from dynsim_ros.scene import load_scene, Particle, Scene, with_values
from dynsim_ros.simulation import MoveAnchor, PushBody, Settings, SetValues, Simulator
import numpy as np
import pytest

SECOND = 1_000_000_000
MOVING = with_values(load_scene('sphere_on_spring'), {'hand.velocity': (0.3, 0.1, -0.2)})
BARE = Scene(bodies=(Particle(name='p', mass=1, velocity=(0.1, 0.2, 0.3)),))
# How often a run is looked at [Hz].
RATES = [7, 30, 100, 333, 1000, 9999.9]


@pytest.mark.parametrize('rate, tick', [
    (1, SECOND), (3, 333333333), (100, 10_000_000), (333, 3003003), (1000, 1_000_000),
    (29.97, 33366700), (10000, 100_000), (0.1, 10 * SECOND)])
def test_tick_is_the_nearest_integer_number_of_nanoseconds(rate, tick):
    assert Settings(rate=rate).tick_ns == tick


@pytest.mark.parametrize('rate', [333, 29.97])
def test_ticks_never_accumulate_rounding(rate):
    simulator = Simulator(BARE, integrator='rk4', rate=rate)
    tick = simulator.settings.tick_ns
    for number in range(1, 2001):
        simulator.advance_tick()
        assert isinstance(simulator.time_ns, int)
        assert (simulator.time_ns, simulator.tick) == (number * tick, number)


def test_free_motion_is_on_time():
    simulator = Simulator(BARE, integrator='rk4', rate=333)
    for _ in range(333):
        simulator.advance_tick()
    np.testing.assert_allclose(simulator.snapshot().position('p'),
                               0.999999999 * np.array([0.1, 0.2, 0.3]), rtol=1e-13)


def test_run_ends_at_the_first_tick_at_or_after_its_duration():
    simulator = Simulator(BARE, integrator='rk4', rate=100)
    run = simulator.run(0.095)
    assert simulator.time_ns == 100_000_000
    assert len(run.snapshots) == 11
    assert run.time[-1] == 0.1


def commanded(rate, **method):
    """Return snapshots at 1 s and 2 s; commands at 0.5 s, 1 s and 1.25 s, sampled at a rate."""
    simulator = Simulator(MOVING, wrench_timeout=0.1234567, anchor_interpolation='linear',
                          **method)
    period = Settings(rate=rate).tick_ns
    found = []
    for second, command in [(0.5, PushBody('sphere', (1, 2, 3), (0, 0.001, 0))),
                            (1.0, MoveAnchor('hand', (0.3, 0.1, 1.9))),
                            (1.25, SetValues({'spring.stiffness': 130})), (2.0, None)]:
        end = round(second * SECOND)
        while simulator.time_ns < end:
            simulator.advance(min(period, end - simulator.time_ns))
            simulator.snapshot()
        found.append(simulator.snapshot())
        if command:
            simulator.apply(command)
    return found


@pytest.mark.parametrize('method', ['rk4', 'auto'])
def test_ticks_of_another_rate_change_no_bit(method):
    found = []
    for rate, ticks in ((1, 1), (100, 100), (1000, 1000)):
        simulator = Simulator(MOVING, integrator=method, rate=rate)
        for _ in range(ticks):
            simulator.advance_tick()
        found.append(simulator.snapshot())
    assert {snapshot.time_ns for snapshot in found} == {SECOND}
    assert len({snapshot.state.tobytes() for snapshot in found}) == 1


@pytest.mark.parametrize('method', [
    *({'integrator': 'rk4', 'step': step} for step in (1e-3, 7.77e-4, 0.013)),
    *({'integrator': 'auto', 'tolerance': tolerance} for tolerance in (1e-9, 1e-4))])
def test_rate_of_sampling_changes_no_bit(method):
    """Nor of the anchor, of the works or of the energies; the steps lie on a grid of their own."""
    runs = [commanded(rate, **method) for rate in RATES]
    for run in runs[1:]:
        for one, other in zip(runs[0], run):
            assert one.time_ns == other.time_ns
            assert one.state.tobytes() == other.state.tobytes()
            assert one.anchors.tobytes() == other.anchors.tobytes()
            assert one.pushes.tobytes() == other.pushes.tobytes()
            assert one.energy == other.energy


def test_a_sample_off_the_grid_is_as_exact_as_one_on_it():
    """0.5 ms after a point of the grid, against steps that end there."""
    samples = []
    for step in (1e-3, 5e-4):
        simulator = Simulator(MOVING, integrator='rk4', step=step)
        simulator.advance(300_500_000)
        samples.append(simulator.snapshot().position('sphere'))
    np.testing.assert_allclose(samples[0], samples[1], atol=1e-8)


def test_looking_at_a_snapshot_changes_nothing():
    simulator = Simulator(MOVING)
    simulator.run(0.1)
    before = simulator.snapshot()
    simulator.snapshot().state[:] = np.nan
    simulator.snapshot().anchors[:] = np.nan
    assert simulator.snapshot().state.tobytes() == before.state.tobytes()
    assert simulator.snapshot().anchors.tobytes() == before.anchors.tobytes()
