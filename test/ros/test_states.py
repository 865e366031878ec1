# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""States saved, loaded, and gone back to: the run goes on from there to the same bits."""

from dynsim_ros.bag.reader import open_bag
from dynsim_ros.bag.recorded_run import RecordedRun
from dynsim_ros.bag.rerun import compare
from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import Simulator
from dynsim_ros.simulation.checkpoint import checkpoint, restored
from geometry_msgs.msg import WrenchStamped
import numpy as np
import pytest
from recorded import metadata
from ros_client import LATCHED
from scene_topics import EPOCH, POSE, positions
from std_msgs.msg import UInt64
from std_srvs.srv import Trigger


@pytest.fixture(scope='module')
def node(start):
    return start('-p', 'record.enable:=true', '-p', 'integrator:=rk4')


@pytest.fixture(scope='module')
def client(node, connect):
    client = connect(node)
    client.listen({'sphere/pose': POSE})
    client.listen({'epoch': EPOCH}, LATCHED)
    client.more('sphere/pose')
    return client


@pytest.fixture(autouse=True)
def at_the_beginning(client):
    client.pause()
    client.record(True)
    client.reset()
    client.drain()
    client.clear()


def call(client, name, **parameters):
    """Call a service with parameters, state_ for state.; return the response."""
    values = {name.replace('_', '.', 1): value for name, value in parameters.items()}
    assert all(result.successful for result in client.configure(values))
    return client.call(name, Trigger)


def steps(client, count):
    """Step so often; return the positions on the way: (count, 3)."""
    client.configure({'step_count': float(count)})
    before = len(client.heard['sphere/pose'])
    assert client.step().success
    client.wait(lambda: len(client.heard['sphere/pose']) >= before + count)
    return positions(client.messages('sphere/pose')[before:])


def push(client, y):
    """Let a force act on the sphere."""
    command = WrenchStamped()
    command.wrench.force.y = y
    client.publish('sphere/wrench_command', command)
    client.drain()


def test_a_saved_state_is_gone_on_from(node, client):
    push(client, 5.0)
    steps(client, 20)
    client.configure({'gravity': 5.0})
    saved = call(client, 'save_state', state_file='states/a.json')
    assert (saved.success, saved.message) == (True, 'tick 20, 0.2 s: states/a.json')
    expected = steps(client, 40)
    client.set_group({'gravity': 1.0, 'sphere.mass': 2.0, 'rate': 200.0})
    steps(client, 3)
    epoch = int(client.reset().message.split()[1].rstrip(','))
    loaded = call(client, 'load_state')
    assert (loaded.success, loaded.message) == (True, f'epoch {epoch + 1}, tick 20, 0.2 s')
    client.wait(lambda: client.messages('epoch')[-1:] == [UInt64(data=epoch + 1)])
    # what was set is what it was; the force still acts for as long as it would have
    assert client.get('gravity', 'sphere.mass', 'rate') == [5.0, 1.0, 100.0]
    np.testing.assert_array_equal(steps(client, 40), expected)
    # and so it does elsewhere, without a node
    simulator = restored((node.folder / 'states/a.json').read_bytes())
    for position in expected:
        simulator.advance_tick()
        np.testing.assert_array_equal(simulator.snapshot().position('sphere'), position)


def test_a_recorded_instant_of_this_run(node, client):
    push(client, 3.0)
    expected = steps(client, 60)
    parent = node.bags[-1].name
    back = call(client, 'rewind', state_time=0.25)
    assert back.success and back.message.endswith(', tick 25, 0.25 s'), back.message
    np.testing.assert_array_equal(steps(client, 35), expected[25:])
    # back within that, and beyond its beginning
    for time, tick in ((0.5, 50), (0.1, 10)):
        assert call(client, 'rewind', state_time=time).success
        np.testing.assert_array_equal(steps(client, 60 - tick), expected[tick:])
    client.record(False)
    # what came is recorded, and tells where it left
    about = metadata(node.bags[-3])
    assert (about['parent'], about['parent_tick']) == (parent, '25')
    for path in node.bags[-4:]:
        with open_bag(path) as bag:
            outcome = compare(RecordedRun(bag))
        assert outcome.difference is None and outcome.states > 10, path


def test_a_running_node_goes_on_running(client):
    client.pause(False)
    client.more('sphere/pose', 30)
    response = call(client, 'rewind', state_time=0.1)
    assert response.success, response.message
    client.more('sphere/pose', 5)


def test_an_instant_of_a_bag(node, client):
    expected = steps(client, 30)
    client.record(False)
    path = node.bags[-1]
    client.reset()
    response = call(client, 'load_state', state_file=f'runs/{path.name}', state_time=0.12)
    assert response.success and response.message.endswith(', tick 12, 0.12 s')
    np.testing.assert_array_equal(steps(client, 18), expected[12:])


def refused(client, name, **parameters):
    """Call a service that has to be refused and change nothing; return the message."""
    before = client.get('gravity'), len(client.heard['epoch'])
    response = call(client, name, **parameters)
    assert not response.success
    client.drain()
    assert (client.get('gravity'), len(client.heard['epoch'])) == before
    return response.message


def test_what_is_refused(node, client):
    folder = node.folder
    assert refused(client, 'load_state', state_file='no.json') == (
        'state.file: no.json cannot be read: No such file or directory')
    (folder / 'text.json').write_text('{}')
    assert refused(client, 'load_state', state_file='text.json') == (
        'state.file: text.json is no checkpoint of a run')
    assert refused(client, 'save_state', state_file='text.json') == (
        'state.file: text.json is no saved state and stays; choose another')
    assert refused(client, 'save_state', state_file='/proc/a/b.json').startswith(
        'state.file: /proc/a/b.json cannot be written: ')
    (folder / 'box.json').write_text(checkpoint(Simulator(load_scene('spinning_box'))))
    assert refused(client, 'load_state', state_file='box.json').startswith(
        "state.file: box.json is a state of the scene 'spinning_box', with other bodies")
    steps(client, 10)
    assert refused(client, 'rewind', state_time=0.5) == (
        'state.time: 0.5 s has not come yet, this is tick 10, 0.1 s')
    client.record(False)
    client.reset()
    steps(client, 10)
    assert refused(client, 'rewind', state_time=0.05) == (
        'state.time: 0.05 s is not recorded; go back to what is, or record from the start '
        '(record.enable)')


def test_it_ends_well(node):
    node.stop()
