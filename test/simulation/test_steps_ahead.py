# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A step taken before its tick is due changes no bit, whatever comes between."""

from contextlib import nullcontext

from by_hand import nothing_compiled
from dynsim_ros.integrators import METHODS
from dynsim_ros.scene import load_scene, scene_names
from dynsim_ros.simulation import DivergenceError, MoveAnchor, PushBody, SetValues, Simulator
import pytest
from references import load

# These take longer to compile than to run as plain Python.
RARE = 'stiff', 'radau', 'dop853'
# Ticks after which something happens.
PARTS = 1, 2, 40, 7, 3, 90


def advance(simulator, ticks, ahead):
    for _ in range(ticks):
        if ahead:
            simulator.step_ahead()
        simulator.advance_tick()
    if ahead:
        # What happens next finds the next tick known.
        assert simulator.step_ahead() > 0


def memories(scene, ahead, parts=PARTS, **settings):
    """Return all that a run with commands keeps, after each part of it."""
    simulator, found = Simulator(load_scene(scene), rate=1000.0, **settings), []
    body, anchors = simulator.layout.bodies[0], simulator.layout.anchors
    for ticks in parts:
        advance(simulator, ticks, ahead)
        found.append((simulator.counts, simulator.shortfall, simulator.normalisation_removed,
                      simulator.memory()))
        advance(simulator, 1, ahead)
        simulator.apply(PushBody(body, (0.1 * ticks, 0.0, 1.0)))
        if ahead:
            # The motion begins anew then, and again with the next command.
            simulator.step_ahead()
        for anchor in anchors[:1]:
            simulator.apply(MoveAnchor(anchor, (1e-3 * ticks, 0.0, 2.0)))
        advance(simulator, 1, ahead)
        simulator.apply(SetValues({f'{body}.mass': 1.0 + 0.01 * ticks}))
    return found


@pytest.mark.parametrize('scene', scene_names())
def test_every_scene(scene):
    assert memories(scene, True) == memories(scene, False)


@pytest.mark.parametrize('method', METHODS)
def test_every_method(method):
    settings = {'integrator': method, 'anchor_interpolation': 'linear', 'wrench_timeout': 0.0205,
                'parts': (1, 2, 3) if method in RARE else PARTS}
    with nothing_compiled() if method in RARE else nullcontext():
        assert (memories('sphere_on_spring', True, **settings)
                == memories('sphere_on_spring', False, **settings))


def test_many_steps_of_fixed_length_are_taken_at_once():
    simulator = Simulator(load_scene('sphere_on_spring'), rate=1000.0, integrator='rk4')
    simulator.advance_tick()
    assert simulator.step_ahead() == 64
    simulator.take(10)
    assert simulator.step_ahead() == 54
    # Who looks finds those alone that ticks have needed.
    assert simulator.counts == (11, 0)


def test_a_method_that_goes_over_to_the_stiff_one_and_back():
    found = []
    with nothing_compiled():
        for ahead in False, True:
            simulator, kept = Simulator(load('S3q')[0], tolerance=1e-2, rate=300.0), []
            for tick in range(12):
                if tick == 9:
                    simulator.apply(PushBody('ball', (0.0, 1.0, 0.0)))
                advance(simulator, 1, ahead)
                kept.append(simulator.memory())
            found.append(kept)
    assert found[0] == found[1]
    assert len({memory['steps']['steps']['is_stiff'] for memory in found[0]}) == 2


@pytest.mark.parametrize('method', ['auto', 'rk4'])
@pytest.mark.parametrize('go_on', [
    lambda simulator: simulator.advance_ticks(5), lambda simulator: simulator.advance(5_000_000),
    lambda simulator: simulator.apply(SetValues({'gravity': 5.0})), Simulator.prepare,
    Simulator.reset], ids=['ticks', 'time', 'values', 'prepare', 'reset'])
def test_whatever_comes_after_a_beginning_that_was_ahead(method, go_on):
    found = []
    for ahead in False, True:
        simulator = Simulator(load_scene('sphere_on_spring'), rate=1000.0, integrator=method)
        advance(simulator, 20, ahead)
        simulator.apply(MoveAnchor('hand', (0.1, 0.0, 2.0)))
        if ahead:
            assert simulator.step_ahead() > 0
        go_on(simulator)
        advance(simulator, 20, ahead=False)
        found.append(simulator.memory())
    assert found[0] == found[1]


def test_divergence_comes_with_its_tick():
    found = []
    for ahead in False, True:
        simulator = Simulator(load_scene('sphere_on_spring'), rate=1000.0, integrator='rk4',
                              step=0.2)
        with pytest.raises(DivergenceError):
            for _ in range(100_000):
                if ahead:
                    simulator.step_ahead()
                simulator.advance_tick()
        assert simulator.step_ahead() == 0
        found.append((simulator.tick, simulator.failure, simulator.memory()))
    assert found[0] == found[1]


def test_a_copy_and_a_twin_are_not_touched_by_what_is_taken_back():
    simulator = Simulator(load_scene('sphere_on_spring'), rate=1000.0)
    advance(simulator, 30, ahead=True)
    copy, twin = simulator.copy(), simulator.twin()
    before = copy.snapshot().state.tobytes()
    simulator.step_ahead()
    simulator.apply(PushBody('sphere', (1.0, 0.0, 0.0)))
    advance(twin, 30, ahead=False)
    alone = Simulator(load_scene('sphere_on_spring'), rate=1000.0)
    advance(alone, 60, ahead=False)
    assert copy.snapshot().state.tobytes() == before
    assert twin.memory() == alone.memory()
