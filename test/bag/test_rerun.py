# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded run lived again: what is compared, what is found, and from which bags."""

from dynsim_ros.bag.bag_files import Limits
from dynsim_ros.bag.bag_names import new_path
from dynsim_ros.bag.reader import BagError, open_bag
from dynsim_ros.bag.recorded_run import RecordedRun
from dynsim_ros.bag.rerun import compare, simulator_at
from dynsim_ros.bag.run_sink import RunSink
from dynsim_ros.messages.cdr import decode, encode
from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import SetValues, Simulator
from dynsim_ros.simulation.offline import OfflineRun
from dynsim_ros.simulation.state_hash import state_hash
import numpy as np
import pytest
from recorded import messages, record, rewritten, script, TICK

SCENE = load_scene('sphere_on_spring')
SETTINGS = {'integrator': 'rk4', 'step': 0.004}
POSE, HASH = '/dynsim/sphere/pose', '/dynsim/state_hash'
TICKS = 250


@pytest.fixture(scope='module')
def bag(tmp_path_factory):
    """Return the path of a bag of a run with commands of every kind."""
    path = tmp_path_factory.mktemp('rerun') / 'run.mcap'
    record(path, SCENE, TICKS, script('everything', SCENE, TICKS), **SETTINGS)
    return path


def outcome(path, *times):
    """Return what comes of living a bag again."""
    with open_bag(path) as bag:
        return compare(RecordedRun(bag), *times)


def test_all_states_and_hashes_are_compared(bag):
    found = outcome(bag)
    assert found.difference is None
    # the rate is 200 Hz from half of the run on: 1, 0.5 s later, twice as many ticks
    assert found.states == len(messages(bag)[POSE]) == 125 + 1 + 250
    assert found.hashes == len(messages(bag)[HASH])
    assert found.commands == len(script('everything', SCENE, TICKS))
    assert found.time_ns == TICKS * TICK


def test_a_hash_every_second_and_at_the_end(bag, tmp_path):
    record(tmp_path / 'run.mcap', SCENE, 350, **SETTINGS)
    assert list(messages(tmp_path / 'run.mcap')[HASH]) == [
        0, 100 * TICK, 200 * TICK, 300 * TICK, 350 * TICK]


def test_hashes_alone_are_enough(bag, tmp_path):
    """As of a long run, of which nobody keeps the states."""
    def light(topic, _, data):
        return data if topic == HASH or 'command' in topic or 'group' in topic else None

    path = rewritten(bag, tmp_path / 'light.mcap', light)
    assert path.stat().st_size < 0.2 * bag.stat().st_size
    found = outcome(path)
    assert (found.states, found.difference) == (0, None)
    assert found.hashes == len(messages(bag)[HASH])

    last_but_one = [*messages(bag)[HASH]][-2]

    def other(topic, stamp, data):
        if topic == HASH and stamp == last_but_one:
            text = decode('std_msgs/msg/String', data)['data']
            return encode('std_msgs/msg/String', {'data': text[:-1] + ('0', '1')[text[-1] == '0']})
        return light(topic, stamp, data)

    difference = outcome(rewritten(bag, tmp_path / 'other.mcap', other)).difference
    assert difference.time_ns == last_but_one
    assert difference.quantity == 'the hash of the whole state'


def by_one_bit(data):
    """Return CDR bytes of a PoseStamped with another last bit in position.x."""
    values = decode('geometry_msgs/msg/PoseStamped', data)
    position = values['pose']['position']
    position['x'] = float(np.nextafter(position['x'], 9.0))
    return encode('geometry_msgs/msg/PoseStamped', values)


def test_one_bit_is_found_where_it_is(bag, tmp_path):
    path = rewritten(bag, tmp_path / 'run.mcap', lambda topic, stamp, data: by_one_bit(data)
                     if topic == POSE and stamp >= 37 * TICK else data)
    found = outcome(path)
    assert found.states == 37
    difference = found.difference
    assert (difference.tick, difference.time_ns) == (37, 37 * TICK)
    assert difference.quantity == 'sphere/pose pose.position.x'
    x = decode('geometry_msgs/msg/PoseStamped', messages(bag)[POSE][37 * TICK])[
        'pose']['position']['x']
    other = float(np.nextafter(x, 9.0))
    assert str(difference) == (
        f'tick 37, 0.37 s: sphere/pose pose.position.x is {other!r} m in the bag, {x!r} m here, a '
        f'difference of {other - x:.2g} m')


def test_every_topic_of_a_state_is_compared(tmp_path):
    """The last number of every topic but the markers, which draw the others."""
    bag = tmp_path / 'bag.mcap'
    record(bag, SCENE, 8, **SETTINGS)
    topics = {topic: stamps for topic, stamps in messages(bag).items() if 'command' not in topic
              and topic not in ('/dynsim/markers', '/dynsim/epoch')}
    assert len(topics) == 11
    for changed, stamps in topics.items():
        stamp = [*stamps][-1]
        data = bytearray(stamps[stamp])
        place = len(data) - 4 if changed == HASH else len(data) - 8
        data[place] ^= 1
        place, other = (changed, stamp), bytes(data)
        path = rewritten(
            bag, tmp_path / 'run.mcap', lambda topic, at, content, place=place, other=other:
            other if (topic, at) == place else content)
        difference = outcome(path).difference
        assert difference is not None and difference.time_ns == stamp, changed


def test_a_command_that_is_missing_or_later_is_found(bag, tmp_path):
    topic = '/dynsim/hand/command'
    (second,) = [stamp for stamp in messages(bag)[topic] if stamp == 75 * TICK]
    path = rewritten(bag, tmp_path / 'run.mcap', lambda name, stamp, data: None
                     if (name, stamp) == (topic, second) else data)
    difference = outcome(path).difference
    assert difference.tick == 76


def test_from_and_until(bag):
    found = outcome(bag, 100 * TICK, 120 * TICK)
    assert (found.states, found.difference, found.time_ns) == (21, None, 120 * TICK)


def test_the_state_at_any_instant_is_that_of_the_run(bag):
    simulator = Simulator(SCENE, **SETTINGS)
    commands = script('everything', SCENE, TICKS)
    hashes = {}
    while simulator.time_ns < TICKS * TICK:
        hashes[simulator.time_ns] = state_hash(simulator.snapshot())
        while commands and commands[0][0] <= simulator.time_ns:
            simulator.apply(commands.pop(0)[1])
        simulator.advance_tick()
    with open_bag(bag) as opened:
        run = RecordedRun(opened)
        # also where commands come, and between two ticks
        for asked, found in ((0, 0), (75, 75), (100.3, 101), (125, 125), (200.2, 200.5)):
            there = simulator_at(run, round(asked * TICK))
            assert there.time_ns == found * TICK
            assert state_hash(there.snapshot()) == hashes[found * TICK]
        with pytest.raises(BagError, match='holds 0 s to 2.5 s of its run, not 3 s'):
            simulator_at(run, 300 * TICK)


def test_a_bag_that_begins_within_a_run(tmp_path):
    """The steps of the integrator go on: they do not begin anew where the bag does."""
    simulator = Simulator(SCENE, integrator='extrapolation')
    simulator.advance_ticks(33)
    simulator.apply(SetValues({'gravity': 9.0}))
    simulator.advance_ticks(4)
    path = tmp_path / 'run.mcap'
    sink = RunSink(path, simulator)
    OfflineRun(simulator, [], sink).run(0.5)
    sink.close()
    found = outcome(path)
    assert (found.states, found.difference) == (51, None)
    again = Simulator(SCENE, integrator='extrapolation')
    again.advance_ticks(33)
    again.apply(SetValues({'gravity': 9.0}))
    again.advance_ticks(54)
    assert state_hash(again.snapshot()) == state_hash(simulator.snapshot())


def test_every_part_of_a_bag_is_a_run(tmp_path):
    simulator = Simulator(SCENE, **SETTINGS)
    sink = RunSink(new_path(tmp_path, 'run', True), simulator,
                   limits=Limits(duration_ns=60 * TICK))
    OfflineRun(simulator, script('everything', SCENE, TICKS), sink).run(TICKS * TICK * 1e-9)
    sink.close()
    parts = sorted(tmp_path.iterdir())
    found = [outcome(part) for part in parts]
    assert len(parts) == 5 and [one.difference for one in found] == [None] * 5
    assert sum(one.states for one in found) == 376
    assert sum(one.commands for one in found) == len(script('everything', SCENE, TICKS))


def test_a_group_of_parameters_is_one_command(tmp_path):
    """Of these, each alone would let the steps begin anew, and publish at another rate."""
    group = {'rate': 50.0, 'step': 0.002, 'gravity': 3.0, 'down': (0.0, 1.0, -1.0)}
    commands = [(10 * TICK, SetValues(group)), (10 * TICK, SetValues({'gravity': 4.0})),
                (12 * TICK, SetValues({'spring.damping': 0.25}))]
    record(tmp_path / 'run.mcap', SCENE, 20, commands, **SETTINGS)
    with open_bag(tmp_path / 'run.mcap') as opened:
        run = RecordedRun(opened)
        found = run.commands()
        assert compare(run).difference is None
    assert [time_ns for time_ns, _ in found] == [time_ns for time_ns, _ in commands]
    down = np.array([0.0, 1.0, -1.0]) / np.sqrt(2.0)
    np.testing.assert_allclose(found[0][1].values.pop('down'), down, rtol=1e-15)
    del group['down']
    assert [command.values for _, command in found] == [
        group, {'gravity': 4.0}, {'spring.damping': 0.25}]


def test_bags_without_a_checkpoint_hold_a_run_if_they_begin_with_it(bag, tmp_path):
    path = rewritten(bag, tmp_path / 'old.mcap', without=('checkpoint.json', 'topics'))
    assert outcome(path).difference is None


@pytest.mark.parametrize(('without', 'said'), [
    (('dynsim_ros',), 'holds no run: it was not recorded by sim_node, simulate or rerun'),
    (('scene.yaml',), 'holds no run'),
    (('checkpoint.json', 'parameters'), None)])
def test_what_holds_no_run(bag, tmp_path, without, said):
    path = rewritten(bag, tmp_path / 'run.mcap', without=without)
    if said is None:
        # the settings were not the ones by default
        assert outcome(path).difference is not None
        return
    with pytest.raises(BagError) as caught:
        outcome(path)
    (line,) = str(caught.value).splitlines()
    assert line.startswith(f'{path} ') and said in line


def test_a_command_that_cannot_be_read_or_carried_out(bag, tmp_path):
    topic = '/dynsim/sphere/wrench_command'
    path = rewritten(bag, tmp_path / 'a.mcap', lambda name, _, data: data[:20]
                     if name == topic else data)
    with pytest.raises(BagError, match='a command of 0 s cannot be read'):
        outcome(path)
    topic = '/dynsim/parameter_command'
    mass = encode('rcl_interfaces/msg/Parameter',
                  {'name': 'sphere.mass', 'value': {'type': 3, 'double_value': -1.0}})
    path = rewritten(bag, tmp_path / 'b.mcap', lambda name, stamp, data: mass
                     if name == topic and stamp == 25 * TICK else data)
    with pytest.raises(BagError, match='the command of tick 25, 0.25 s, cannot be carried out: '
                                       'sphere.mass: -1 kg is out of range'):
        outcome(path)
