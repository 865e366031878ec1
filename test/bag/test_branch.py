# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A run that goes on differently from an instant on is what it had become with that from there."""

from dynsim_ros.bag.branch import branch, Changes
from dynsim_ros.bag.reader import open_bag
from dynsim_ros.bag.recorded_run import RecordedRun
from dynsim_ros.scene import load_scene, parse_scene, SceneError, with_values
from dynsim_ros.simulation import MoveAnchor, PushBody, SetValues, Simulator
from dynsim_ros.simulation.state_hash import state_hash
import numpy as np
import pytest
from recorded import record, script, TICK

SCENE = load_scene('sphere_on_spring')
SETTINGS = {'integrator': 'rk4', 'step': 0.004}
TICKS = 60
LEFT = 24 * TICK
PUSH = PushBody('sphere', (0.0, 3.0, 0.0))
# Among the anchors and without the one that is there: other bodies and springs.
OTHER = parse_scene("""
gravity: 9.81
anchors: {hand: {position: [0, 0, 3]}}
bodies:
  sphere: {shape: particle, mass: 2, position: [0, 0, 1]}
  second: {shape: particle, mass: 1, position: [0, 0, 0.5]}
springs: {link: {from: sphere, to: second, stiffness: 30, natural_length: 0.5}}""")


@pytest.fixture(scope='module')
def bag(tmp_path_factory):
    """Return the path of a bag of a run with commands of every kind."""
    path = tmp_path_factory.mktemp('branch') / 'run.mcap'
    record(path, SCENE, TICKS, script('everything', SCENE, TICKS), **SETTINGS)
    return path


def made(path, begin_ns, **changes):
    """Return a Branch of a bag."""
    with open_bag(path) as bag:
        return branch(RecordedRun(bag), begin_ns, Changes(**changes))


def live(simulator, commands, end_ns=TICKS * TICK):
    """Return {time [ns]: hash of the state} of a Simulator that is commanded, to an instant."""
    hashes, commands = {}, list(commands)
    while True:
        hashes[simulator.time_ns] = state_hash(simulator.snapshot())
        if simulator.time_ns >= end_ns:
            return hashes
        while commands and commands[0][0] <= simulator.time_ns:
            simulator.apply(commands.pop(0)[1])
        simulator.advance_tick()


def as_if(*more, before=TICKS):
    """Return the hashes of the run with commands beside those before a tick."""
    commands = [timed for timed in script('everything', SCENE, TICKS) if timed[0] < before * TICK]
    commands = sorted([*commands, *more], key=lambda timed: timed[0])
    return live(Simulator(SCENE, **SETTINGS), commands)


def assert_follows(branched, hashes):
    """Compare a Branch with {time: hash} of the run that it has to be."""
    found = live(branched.simulator, branched.commands)
    assert found == {time_ns: hashes[time_ns] for time_ns in found}
    assert min(found) == LEFT and max(found) == TICKS * TICK


def test_without_changes_it_is_the_run(bag):
    branched = made(bag, LEFT)
    hashes = as_if()
    assert branched.parent == {
        'parent': 'run.mcap', 'parent_epoch': '0', 'parent_tick': '24',
        'parent_time_ns': str(LEFT), 'parent_hash': hashes[LEFT]}
    assert_follows(branched, hashes)


def test_values_change_as_if_they_had_been_set_then(bag):
    values = {'spring.stiffness': 200.0, 'gravity': 1.62}
    assert_follows(made(bag, LEFT, values=values), as_if((LEFT, SetValues(values))))


def test_commands_replace_the_recorded_ones(bag):
    commands = [(LEFT, PUSH), (40 * TICK, MoveAnchor('hand', (0.2, 0.0, 2.0)))]
    assert_follows(made(bag, LEFT, commands=commands), as_if(*commands, before=24))
    assert_follows(made(bag, LEFT, commands=[]), as_if(before=24))


def test_commands_beside_the_recorded_ones(bag):
    commands = [(26 * TICK, PUSH)]
    assert_follows(made(bag, LEFT, commands=commands, keep_commands=True), as_if(*commands))


def test_between_ticks_it_begins_at_the_next_one(bag):
    assert made(bag, LEFT - TICK // 3).simulator.time_ns == LEFT


def test_the_wish_for_another_scene_at_the_beginning_is_a_run_of_it(bag):
    heavier = with_values(SCENE, {'sphere.mass': 3.0})
    branched = made(bag, None, scene=heavier, commands=[])
    assert live(branched.simulator, []) == live(Simulator(heavier, **SETTINGS), [])
    branched = made(bag, None, values={'sphere.position': [0.1, 0.0, 1.0]}, commands=[])
    assert live(branched.simulator, []) == live(Simulator(
        with_values(SCENE, {'sphere.position': [0.1, 0.0, 1.0]}), **SETTINGS), [])
    with pytest.raises(SceneError, match='sphere.position: is an initial condition'):
        made(bag, LEFT, values={'sphere.position': [0.1, 0.0, 1.0]})


def test_another_scene_goes_on_from_where_bodies_and_anchors_are(bag):
    before, after = (made(bag, LEFT, commands=[], **changes).simulator.snapshot()
                     for changes in ({}, {'scene': OTHER}))
    assert (after.time_ns, after.tick) == (before.time_ns, before.tick)
    np.testing.assert_array_equal(after.position('sphere'), before.position('sphere'))
    np.testing.assert_array_equal(after.velocity('sphere'), before.velocity('sphere'))
    np.testing.assert_array_equal(after.anchor_position('hand'), before.anchor_position('hand'))
    np.testing.assert_array_equal(after.position('second'), [0.0, 0.0, 0.5])
    assert after.energy.imbalance == 0.0


@pytest.mark.parametrize(('changes', 'said'), [
    ({'values': {'spring.stifness': 1.0}}, "did you mean 'spring.stiffness'?"),
    ({'values': {'gravity': -1.0}}, 'gravity: -1 m/s^2 is out of range'),
    ({'commands': [(TICK, PUSH)]}, 'a command at 0.01 s lies before the branch, which begins at '
                                   '0.24 s'),
    ({'scene': load_scene('spinning_box')}, 'the recorded command at 0.24 s: ')])
def test_what_is_not_possible(bag, changes, said):
    with pytest.raises(SceneError) as caught:
        made(bag, LEFT, **changes)
    (line,) = str(caught.value).splitlines()
    assert said in line
