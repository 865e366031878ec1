# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The state of the run, once a second, on /diagnostics."""

from diagnostic_msgs.msg import DiagnosticStatus
import pytest
from ros_client import nanoseconds
from scene_topics import DIAGNOSTICS, NUMBERS, POSE


@pytest.fixture(scope='module')
def node(start):
    return start('-p', 'record.enable:=true')


@pytest.fixture(scope='module')
def client(node, connect):
    client = connect(node)
    client.listen({'sphere/pose': POSE, 'energy': NUMBERS, '/diagnostics': DIAGNOSTICS})
    client.more('/diagnostics', 3)
    client.pause()
    client.more('/diagnostics')
    client.drain()
    return client


@pytest.fixture(scope='module')
def arrays(client):
    return client.messages('/diagnostics')


def values(status):
    return {item.key: item.value for item in status.values}


def test_names_and_levels(arrays):
    for array in arrays:
        assert array.header.frame_id == 'world'
        assert [status.name for status in array.status] == [
            'dynsim: run', 'dynsim: timing', 'dynsim: energy', 'dynsim: recorder']
        assert {status.level for status in array.status} == {DiagnosticStatus.OK}
        assert {status.hardware_id for status in array.status} == {'sphere_on_spring'}


def test_about_once_a_second(arrays):
    # in simulated time, which keeps up with real time but for missed ticks
    between = nanoseconds(arrays[2].header.stamp) - nanoseconds(arrays[1].header.stamp)
    assert 0.5e9 < between < 1.5e9


def test_the_run(arrays):
    running, paused = arrays[2].status[0], arrays[-1].status[0]
    assert (running.message, paused.message) == ('running', 'paused')
    told = values(running)
    seconds = float(told['simulated time [s]'])
    assert seconds == nanoseconds(arrays[2].header.stamp) / 1e9
    assert int(told['tick']) == round(seconds * 100)
    assert told['epoch'] == '0' and told['integrator'] == 'auto'
    assert 50.0 < float(told['rate achieved [Hz]']) < 130.0
    assert 0.5 < float(told['real-time factor']) < 1.3
    assert int(told['missed ticks']) >= 0 and int(told['late ticks']) >= 0
    assert told['commands refused'] == '0'


def test_energy_is_that_of_the_topic(client, arrays):
    told = values(arrays[-1].status[2])
    numbers = client.last('energy').data
    for number, key in enumerate((
            'kinetic [J]', 'gravitational [J]', 'spring [J]', 'total [J]', 'work of damper [J]',
            'work of air [J]', 'work of anchor [J]', 'work of push [J]')):
        assert float(told[key]) == pytest.approx(numbers[number], rel=1e-8)


def test_timing_of_the_whole_run(arrays):
    told = {key: float(value) for key, value in values(arrays[-1].status[1]).items()}
    lateness = [told[f'lateness of ticks {name} [us]'] for name in ('p50', 'p99', 'max')]
    assert 0.0 <= lateness[0] <= lateness[1] <= lateness[2]
    shares = [told[f'share of {name} [%]'] for name in ('step', 'publish', 'record')]
    assert all(0.0 < share < 100.0 for share in shares)
    assert told['steps of the integrator'] >= 1.0 and told['rejected steps'] >= 0.0


def test_the_recorder(node, arrays):
    told = values(arrays[-1].status[3])
    assert arrays[-1].status[3].message == 'recording'
    assert node.folder / told['file'] == node.bags[0]
    assert int(told['messages']) > 500 and told['lost'] == '0'


def test_what_nobody_listens_to_is_not_built(client):
    client.record(False)
    (array, *_) = client.more('/diagnostics')
    assert array.status[3].message == 'not recording'
    before = int(values(array.status[0])['messages not built (nobody listened)'])
    client.steps(5, 'sphere/pose')
    (array, *_) = client.more('/diagnostics')
    after = int(values(array.status[0])['messages not built (nobody listened)'])
    # two of the nine topics of every tick are listened to; frames and markers come now and then
    assert 5 * 7 <= after - before <= 5 * 7 + 4
