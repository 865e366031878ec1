# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Commands and steps that the method chooses: a step that went past a command is cut back to it.

It is cut the same way in every repetition, whoever looks, and what follows is the motion that
begins there.
"""

from dataclasses import replace

from by_hand import nothing_compiled
from dynsim_ros.scene import with_values
from dynsim_ros.simulation import MoveAnchor, Propagator, PushBody, SetValues, Simulator
import numpy as np
import pytest
from references import load

SCENE = load('S2')[0]
AT = 130_000_000
METHODS = pytest.mark.parametrize('method', ['auto', 'dop853', 'radau'])
COMMANDS = {'push': PushBody('ball', (1, 2, 3), (0.1, 0, 0)),
            'jump': MoveAnchor('hand', (0.1, 0, 2)),
            'value': SetValues({'spring.stiffness': 200})}


def simulator(method, **more):
    return Simulator(SCENE, integrator=method, tolerance=1e-8, **more)


def commanded(method, command, rate):
    """Return the states just before a command, at it, and at two instants after it."""
    run, found = simulator(method, rate=rate), []
    while run.time_ns < AT:
        run.advance_tick()
    found.append(run.snapshot().state)
    run.apply(command)
    found.append(run.snapshot().state)
    for instant in (180_000_000, 230_000_000):
        while run.time_ns < instant:
            run.advance_tick()
        found.append(run.snapshot().state)
    return np.array(found)


@METHODS
@pytest.mark.parametrize('command', COMMANDS)
def test_cut_the_same_way_whoever_looks(method, command):
    rarely = commanded(method, COMMANDS[command], 100)
    np.testing.assert_array_equal(commanded(method, COMMANDS[command], 100), rarely)
    np.testing.assert_array_equal(commanded(method, COMMANDS[command], 200), rarely)


@METHODS
def test_a_cut_step_ends_where_a_run_to_that_instant_ends(method):
    before, at = commanded(method, COMMANDS['push'], 100)[:2]
    with nothing_compiled():
        end = Propagator(SCENE, integrator=method, tolerance=1e-8).end_state(AT * 1e-9)
    np.testing.assert_allclose(at[:-4], end[:-4], rtol=0, atol=2e-8)
    # from the dense output; the step that was cut back had gone farther
    np.testing.assert_allclose(before[:-4], at[:-4], rtol=0, atol=2e-8)
    assert (before != at).any()


@METHODS
def test_what_follows_begins_at_the_command(method):
    """A scene that begins in the state and under the values that the command leaves."""
    run = simulator(method)
    run.advance(AT)
    run.apply(COMMANDS['value'])
    state = run.snapshot().state
    run.advance(100_000_000)
    ball = replace(SCENE.bodies[0], position=tuple(state[:3]), velocity=tuple(state[3:6]),
                   orientation=tuple(state[6:10]), angular_velocity=tuple(state[10:13]))
    anew = Simulator(with_values(replace(SCENE, bodies=(ball,)), {'spring.stiffness': 200}),
                     integrator=method, tolerance=1e-8)
    anew.advance(100_000_000)
    np.testing.assert_allclose(anew.snapshot().state[:-4], run.snapshot().state[:-4], rtol=0,
                               atol=2e-8)


@METHODS
def test_commands_at_the_same_instant_cut_once(method):
    both = simulator(method)
    both.advance(AT)
    both.apply(COMMANDS['jump'])
    state = both.snapshot().state
    both.apply(COMMANDS['push'])
    both.apply(COMMANDS['jump'])
    np.testing.assert_array_equal(both.snapshot().state[:-4], state[:-4])


@METHODS
def test_an_arrival_that_is_known_ends_a_step_without_a_cut(method):
    """An anchor on its way, and a push that ends: the same bits in ticks of any length."""
    def run(rate):
        simulation = simulator(method, rate=rate, anchor_interpolation='linear',
                               wrench_timeout=0.07)
        simulation.apply(MoveAnchor('hand', (0.2, 0.1, 2)))
        simulation.apply(PushBody('ball', (0, 3, 0)))
        simulation.advance(40_000_000)
        while simulation.time_ns < 240_000_000:
            simulation.advance_tick()
        return simulation.snapshot()
    first = run(100)
    np.testing.assert_array_equal(run(25).state, first.state)
    np.testing.assert_array_equal(run(50).anchors, first.anchors)
    np.testing.assert_array_equal(first.anchors[0], [0.2, 0.1, 2, 0, 0, 0])
    assert abs(first.energy.imbalance) < 1e-6
