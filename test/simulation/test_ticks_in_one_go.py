# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Ticks in one go lead to the bits, the ticks and the failures that single ones lead to."""

from dynsim_ros.integrators import METHODS
from dynsim_ros.scene import load_scene, scene_names
from dynsim_ros.simulation import (
    DivergenceError,
    MoveAnchor,
    PushBody,
    SetValues,
    Simulator,
)
from dynsim_ros.simulation.simulator import MOST_AT_ONCE
import pytest


def stand(simulator):
    """Return where a simulator stands, to the last bit."""
    snapshot = simulator.snapshot()
    return (simulator.time_ns, simulator.tick, simulator.failure, snapshot.state.tobytes(),
            snapshot.anchors.tobytes(), snapshot.pushes.tobytes())


def one_by_one(simulator, ticks):
    for _ in range(ticks):
        simulator.advance_tick()


def both(scene, ticks, **settings):
    """Return where two simulators stand: after single ticks, and after ticks in one go."""
    single, at_once = (Simulator(load_scene(scene), **settings) for _ in range(2))
    one_by_one(single, ticks)
    at_once.advance_ticks(ticks)
    return stand(single), stand(at_once)


@pytest.mark.timeout(300)  # compiles first
@pytest.mark.parametrize('scene', scene_names())
def test_every_scene(scene):
    single, at_once = both(scene, 700)
    assert at_once == single and single[1] == 700


@pytest.mark.parametrize('method', METHODS)
def test_every_method(method):
    single, at_once = both('sphere_on_spring', 300, integrator=method, rate=1234.5)
    assert at_once == single


@pytest.mark.parametrize('scene', ['sphere_on_spring', 'particle_on_spring', 'spinning_box'])
def test_looking_ahead_changes_nothing(scene):
    """Run ticks, and instants for which nothing is looked ahead; all that is kept is alike."""
    found = []
    for ahead in True, False:
        simulator = Simulator(load_scene(scene), rate=1000.0, anchor_interpolation='linear')
        body, memories = simulator.layout.bodies[0], []
        for ticks in (1, 2, 40, 7, 100, 150):
            for _ in range(ticks):
                simulator.advance_tick() if ahead else simulator.advance(1_000_000)
            memories.append({**simulator.memory(), 'tick': 0})
            simulator.apply(PushBody(body, (0.1 * ticks, 0.0, 1.0)))
            for anchor in simulator.layout.anchors[:1]:
                simulator.apply(MoveAnchor(anchor, (1e-3 * ticks, 0.0, 2.0)))
        found.append(memories)
    assert found[0] == found[1]


def test_a_copy_does_not_take_what_was_looked_ahead():
    simulator = Simulator(load_scene('sphere_on_spring'), rate=1000.0)
    one_by_one(simulator, 5)
    before = stand(simulator)
    simulator.copy().advance_tick()
    one_by_one(simulator, 5)
    alone = Simulator(load_scene('sphere_on_spring'), rate=1000.0)
    one_by_one(alone, 5)
    assert stand(alone) == before
    one_by_one(alone, 5)
    assert stand(simulator) == stand(alone)


def test_more_than_are_kept_at_a_time():
    single, at_once = both('sphere_on_spring', 2 * MOST_AT_ONCE + 1, rate=1000.0)
    assert at_once == single


@pytest.mark.parametrize('parts', [(1,) * 400, (400,), (7, 100, 1, 292), (39, 361)])
def test_commands_that_end_on_the_way(parts):
    """Push for 35.5 ticks and let the anchor move for ten: both end within what is run at once."""
    found = []
    for ticks in (400,), parts:
        simulator = Simulator(load_scene('sphere_on_spring'), anchor_interpolation='linear',
                              wrench_timeout=0.355)
        simulator.advance_ticks(5)
        simulator.apply(PushBody('sphere', (0, 3, 0)))
        simulator.apply(MoveAnchor('hand', (0.1, 0, 2)))
        for count in ticks:
            if len(parts) == 400:
                one_by_one(simulator, count)
            else:
                simulator.advance_ticks(count)
        simulator.apply(SetValues({'rate': 50.0}))
        simulator.advance_ticks(3)
        found.append(stand(simulator))
    assert found[0] == found[1]


@pytest.mark.parametrize(('settings', 'values'), [
    ({'integrator': 'explicit_euler', 'step': 0.1}, {'spring.stiffness': 1e6}),
    ({'integrator': 'rk4', 'step': 0.05}, {'spring.damping': 1e4}),
    ({'integrator': 'dop853'}, {'spring.stiffness': 1e12, 'sphere.mass': 1e-9})])
def test_a_motion_that_diverges(settings, values):
    found = []
    for ticks in (1, 1000):
        simulator = Simulator(load_scene('sphere_on_spring'), **settings)
        simulator.apply(SetValues(values))
        with pytest.raises(DivergenceError):
            while True:
                simulator.advance_ticks(ticks)
        with pytest.raises(DivergenceError):
            simulator.advance_ticks(ticks)
        found.append(stand(simulator))
    assert found[0] == found[1] and found[0][2]
