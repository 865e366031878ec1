# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A run goes on from a checkpoint to the same bits, wherever it was taken, by every method."""

from contextlib import nullcontext
import json
import sys

from by_hand import nothing_compiled
from dynsim_ros.integrators import METHODS
from dynsim_ros.scene import load_scene, parse_scene, scene_names
from dynsim_ros.simulation import MoveAnchor, PlaceBody, PushBody, SetValues, Simulator
from dynsim_ros.simulation.checkpoint import checkpoint, CheckpointError, restored
from dynsim_ros.simulation.state_hash import state_hash
from dynsim_ros.simulation.step_memory import recall, remember
import numpy as np
from plain import environment
import pytest
from references import load
from tree import output_of

TICK = 10_000_000
DAMPED = parse_scene("""
gravity: 9.81
air: {linear_drag: 2.0, rotational_drag: 0.01}
anchors: {hand: {position: [0, 0, 2]}}
bodies:
  ball: {shape: sphere, mass: 1, radius: 0.1, position: [0.3, 0, 1.2], angular_velocity: [1, 2, 3]}
springs: {spring: {from: hand, to: ball, stiffness: 100, damping: 3, natural_length: 0.5}}""")


def commands_for(scene):
    """Return [(tick, command)] of every kind that a scene takes."""
    body = scene.bodies[0].name
    commands = [(0, PushBody(body, (0.0, 0.1, 0.2))), (3, PushBody(body, (1.0, 2.0, 3.0))),
                (6, PlaceBody(body, {'velocity': (0.1, 0.0, 0.2)})),
                (9, SetValues({'rate': 200.0, 'wrench_timeout': 0.0})),
                (14, PushBody(body, (0.0, -1.0, 0.0)))]
    for anchor in scene.anchors:
        commands += [(0, MoveAnchor(anchor.name, (0.01, 0.02, 2.0))),
                     (4, MoveAnchor(anchor.name, (0.11, 0.0, 2.0))),
                     (7, MoveAnchor(anchor.name, (0.12, 0.0, 2.0))),
                     (11, SetValues({f'{anchor.name}.velocity': (0.0, 0.1, 0.0)}))]
    return sorted(commands, key=lambda timed: timed[0])


def live(simulator, commands, ticks, taken=None):
    """Run to a tick; return the hashes at every tick, and write checkpoints to a dict `taken`."""
    hashes = {}
    while True:
        hashes[simulator.tick] = state_hash(simulator.snapshot())
        if taken is not None:
            taken[simulator.tick] = checkpoint(simulator)
        if simulator.tick >= ticks:
            return hashes
        for tick, command in commands:
            if tick == simulator.tick:
                simulator.apply(command)
        simulator.advance_tick()


def assert_goes_on(simulator, commands, ticks, where=None):
    """Compare a run with what goes on from its checkpoints at some ticks, all unless told."""
    taken = {}
    hashes = live(simulator, commands, ticks, taken)
    for tick in taken if where is None else where:
        again = live(restored(taken[tick]), commands, ticks)
        assert again == {at: found for at, found in hashes.items() if at >= tick}, tick
    return taken


# These take longer to compile than to run as plain Python.
RARE = ('stiff', 'radau', 'dop853')


@pytest.mark.parametrize('method', METHODS)
def test_every_method(method):
    scene = load_scene('sphere_on_spring')
    with nothing_compiled() if method in RARE else nullcontext():
        simulator = Simulator(scene, integrator=method, tolerance=1e-4, step=0.003,
                              anchor_interpolation='linear', wrench_timeout=0.025)
        ticks, where = (6, (1, 5)) if method in RARE else (20, (0, 3, 4, 5, 8, 16))
        assert_goes_on(simulator, commands_for(scene), ticks, where)


@pytest.mark.parametrize('name', scene_names())
def test_every_scene(name):
    """The integrator chooses by itself: closed forms, steps, and what is at rest."""
    scene = load_scene(name)
    assert_goes_on(Simulator(scene), commands_for(scene), 20, (0, 2, 7, 13))
    assert_goes_on(Simulator(scene), [], 20, (0, 1, 7))


def test_while_auto_is_stiff_or_tries_to_be():
    scene = load('S3q')[0]
    with nothing_compiled():
        simulator = Simulator(scene, tolerance=1e-2, rate=300.0)
        taken = assert_goes_on(simulator, [(9, PushBody('ball', (0.0, 1.0, 0.0)))], 11, (5, 8))
    steps = [json.loads(text)['steps'] for text in taken.values()]
    at_work = [memory['steps']['is_stiff'] for memory in steps if memory]
    assert True in at_work and False in at_work


def test_while_a_run_is_asleep():
    simulator = Simulator(DAMPED, rate=10.0)
    simulator.advance_ticks(600)
    commands = [(603, MoveAnchor('hand', (0.01, 0.0, 2.0)))]
    taken = assert_goes_on(simulator, commands, 608)
    memory = json.loads(taken[601])['steps']['steps']
    assert memory['asleep_at'] is not None and memory['asleep_at'] < 60.0


def test_in_another_process():
    simulator = Simulator(load_scene('falling_in_wind'))
    simulator.apply(PushBody('ball', (0.0, 0.3, 0.0)))
    simulator.advance(123_000_000)
    text = checkpoint(simulator)
    simulator.advance(100 * TICK)
    script = ('import sys; from dynsim_ros.simulation.checkpoint import restored; '
              'from dynsim_ros.simulation.state_hash import state_hash; '
              f'run = restored(sys.argv[1]); run.advance(100 * {TICK}); '
              'print(state_hash(run.snapshot()))')
    found = output_of([sys.executable, '-c', script, text], env=environment())
    assert found.strip() == state_hash(simulator.snapshot())


def test_to_take_one_changes_no_bit():
    scene = load_scene('sphere_on_spring')
    assert live(Simulator(scene), commands_for(scene), 20) == live(
        Simulator(scene), commands_for(scene), 20, {})


def test_what_was_compiled_before_a_command_changes_no_bit():
    scene = load_scene('sphere_on_spring')
    prepared = Simulator(scene)
    prepared.prepare()
    assert live(prepared, commands_for(scene), 20) == live(
        Simulator(scene), commands_for(scene), 20)


def test_the_hash_tells_every_part_of_a_state_from_every_other():
    def found(*commands, ticks=0, **settings):
        simulator = Simulator(load_scene('sphere_on_spring'), **settings)
        for command in commands:
            simulator.apply(command)
        simulator.advance_ticks(ticks)
        return state_hash(simulator.snapshot())

    push, move = PushBody('sphere', (0.0, 1.0, 0.0)), MoveAnchor('hand', (0.0, 0.0, 2.0))
    hashes = [found(), found(ticks=1), found(push), found(push, wrench_timeout=1.0), found(move),
              found(tolerance=2e-9), found(SetValues({'sphere.mass': 1.0000000000000002})),
              found(MoveAnchor('hand', (0.0, 0.0, 2.0000000000000004)))]
    assert len(set(hashes)) == len(hashes)
    assert found(push) == found(push)


def test_what_steps_keep_is_saved_or_known():
    """A new attribute of what integrates has to be saved, or to be known as not needed."""
    known = {
        'FixedSteps': {'_memory', 'step_ns', '_model', '_drive', '_advance', 'removed', 'steps',
                       '_origin', '_grid', '_state'},
        'AdaptiveSteps': {'method', 'tolerance', 'watch', 'calm', '_arguments', 'clock',
                          'counts', '_kept', 'states', 'end', '_dense', 'origin', 'nowhere',
                          '_advance'},
        'AutoSteps': {'_cost', 'explicit', '_new_stiff', 'stiff', 'current',
                      '_entered', '_model', '_drive', '_asleep_at'},
        'AutoMotion': {'_new_steps', '_closed', '_steps', '_current', '_stays_closed'}}
    with nothing_compiled():
        for method in ('rk4', 'dop853', 'auto'):
            simulator = Simulator(load_scene('sphere_on_spring'), integrator=method)
            simulator.advance_tick()
            steps = [simulator._steps]
            while steps:
                one = steps.pop()
                assert set(vars(one)) == known[type(one).__name__]
                steps += [part for part in vars(one).values() if type(part).__name__ in known]
                memory = json.dumps(remember(one))
                recall(one, json.loads(memory), (0, np.zeros(simulator.layout.size)))
                assert json.dumps(remember(one)) == memory


@pytest.mark.parametrize(('change', 'said'), [
    (lambda values: values.update(format='x'), 'is no checkpoint of a run'),
    (lambda values: values.update(version=7), 'has version 7, only 2 can be read'),
    (lambda values: values.pop('pushes'), "is damaged: KeyError: 'pushes'"),
    (lambda values: values['state'].pop(), '16 numbers where 17 finite ones are expected'),
    (lambda values: values['state'].__setitem__(0, None), 'is damaged'),
    (lambda values: values['push_ends_ns'].update(nobody=5), "'nobody' is no body"),
    (lambda values: values.update(scene='[]'), 'is damaged: the scene: [] is not a mapping'),
    (lambda values: values.update(steps={}), "is damaged: KeyError: 'steps'"),
    (lambda values: values.update(tick=2), 'its state does not have the hash that it names')])
def test_what_is_none_is_refused_in_one_line(change, said):
    simulator = Simulator(load_scene('sphere_on_spring'))
    simulator.advance_tick()
    values = json.loads(checkpoint(simulator))
    change(values)
    with pytest.raises(CheckpointError) as caught:
        restored(json.dumps(values), 'old.json')
    (line,) = str(caught.value).splitlines()
    assert line.startswith('old.json ') and said in line


def test_a_text_that_is_no_json():
    for text in ('', '{', '[]', '[' * 100_000, 'null'):
        with pytest.raises(CheckpointError, match='^the checkpoint is no checkpoint of a run$'):
            restored(text)
