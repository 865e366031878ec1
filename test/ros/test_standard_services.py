# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The standard services of simulation_interfaces, as programs use them that know no others."""

from importlib import import_module

from dynsim_ros.bag.reader import open_bag
from dynsim_ros.bag.recorded_run import RecordedRun
from dynsim_ros.bag.rerun import compare
from dynsim_ros.ros.standard_services import SERVICES
from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import PlaceBody, SetValues, Simulator
import numpy as np
import pytest
from readme import column, quoted, tables
from ros_client import nanoseconds
from scene_topics import EPOCH, POSE, xyz

STOPPED, PLAYING, PAUSED, QUITTING = range(4)
UNSUPPORTED, OK, NOT_FOUND, _, FAILED = range(5)
ALREADY, NO_TRANSITION, INVALID_POSE = 101, 102, 101
TIME, STATE, SPAWNED = 1, 2, 4
SCENE = load_scene('sphere_on_spring')
TICK = 10_000_000


# Building the types takes long on a busy machine.
pytestmark = pytest.mark.timeout(400)


@pytest.fixture(scope='module')
def node(standard_types, start):
    return start('-p', 'record.enable:=true')


@pytest.fixture(scope='module')
def client(node, connect):
    client = connect(node)
    client.listen({'epoch': EPOCH, 'sphere/pose': POSE})
    client.wait(lambda: client.heard['sphere/pose'], 120.0)
    return client


@pytest.fixture
def paused(client):
    """Give a client of a node that is paused at its beginning."""
    call(client, 'reset_simulation')
    change(client, PAUSED)
    call(client, 'reset_simulation')
    return client


def types(folder):
    """Return simulation_interfaces.msg or srv, which are there when a node is."""
    return import_module(f'simulation_interfaces.{folder}')


def call(client, name, **fields):
    """Call a service; return its response."""
    return client.call(name, getattr(types('srv'), SERVICES[name][0]), **fields)


def result(client, name, **fields):
    """Call a service; return (result code, error message)."""
    found = call(client, name, **fields).result
    return found.result, found.error_message


def change(client, state):
    """Ask for a state of the simulation; return (result code, error message)."""
    return result(client, 'set_simulation_state',
                  state=types('msg').SimulationState(state=state))


def state(client):
    return call(client, 'get_simulation_state').state.state


def entity(client, name='sphere'):
    response = call(client, 'get_entity_state', entity=name)
    assert response.result.result == OK, response.result.error_message
    return response.state


def ticks(client):
    return nanoseconds(entity(client).header.stamp) / TICK


def put(client, name, value):
    return result(client, 'set_entity_state', entity=name, state=value)


def test_they_are_those_of_the_table(client):
    offered = dict(client.node.get_service_names_and_types_by_node('dynsim', '/'))
    found = {name.replace('/dynsim/', '~/'): f'`{kind}`' for name, (kind,) in offered.items()
             if kind.startswith('simulation_interfaces/')}
    (table,) = tables('standard service', 'docs/node.md')
    assert column(table) == found
    shown = {getattr(types('msg').SimulatorFeatures, name)
             for row in table for name in quoted(row[3])}
    assert list(call(client, 'get_simulator_features').features.features) == sorted(shown)


def test_states_and_their_transitions(client):
    assert change(client, PLAYING)[0] in (OK, ALREADY)
    for target in (PAUSED, PLAYING, STOPPED, PLAYING, STOPPED, PAUSED, STOPPED, PAUSED):
        assert change(client, target) == (OK, '')
        assert state(client) == target
        code, text = change(client, target)
        assert code == ALREADY and text.startswith('already so, at tick ')
        if target == STOPPED:
            assert ticks(client) == 0
    for target in (4, 5, 77):
        assert change(client, target) == (
            UNSUPPORTED, f'state: {target} cannot be set; give STATE_STOPPED (0), STATE_PLAYING '
                         '(1), STATE_PAUSED (2) or STATE_QUITTING (3)')


def test_the_own_services_are_seen(client):
    change(client, STOPPED)
    client.step()
    assert state(client) == PAUSED
    client.pause(False)
    assert state(client) == PLAYING
    client.pause(True)
    assert state(client) == PAUSED


def test_steps_are_over_when_they_are_answered(paused):
    for count, end in ((1, 1), (300, 301), (0, 301)):
        assert result(paused, 'step_simulation', steps=count) == (OK, '')
        assert (ticks(paused), state(paused)) == (end, PAUSED)
    assert result(paused, 'step_simulation') == (OK, '')
    assert ticks(paused) == 302


@pytest.mark.parametrize('target', [PLAYING, STOPPED])
def test_no_step_unless_it_is_paused(client, target):
    change(client, target)
    assert result(client, 'step_simulation', steps=5) == (
        FAILED, 'not paused: set the simulation state STATE_PAUSED (2) first')
    assert state(client) == target


def numbers(found):
    """Return pose, twist and acceleration of an EntityState as one list."""
    q = found.pose.orientation
    parts = (found.pose.position, found.twist.linear, found.twist.angular,
             found.acceleration.linear, found.acceleration.angular)
    return [q.x, q.y, q.z, q.w, *(float(a) for part in parts for a in xyz(part))]


def expected(simulator):
    """Return the same of the sphere in a Simulator."""
    now = simulator.snapshot()
    w, x, y, z = now.orientation('sphere')
    accelerations = now.accelerations
    return [x, y, z, w, *now.position('sphere'), *now.velocity('sphere'),
            *now.angular_velocity('sphere'), *accelerations[now.layout.velocity('sphere')],
            *accelerations[now.layout.angular_velocity('sphere')]]


def test_a_body_is_put_elsewhere_and_goes_on_from_there(paused):
    simulator = Simulator(SCENE)
    call(paused, 'step_simulation', steps=20)
    simulator.advance_ticks(20)
    value = entity(paused)
    assert numbers(value) == expected(simulator)
    value.pose.position.x, value.pose.orientation.w, value.pose.orientation.x = 0.5, 0.8, -0.6
    value.pose.orientation.y = value.pose.orientation.z = 0.0
    value.twist.angular.z, value.header.frame_id = 7.0, ''
    value.header.stamp.sec = 99
    assert put(paused, 'sphere', value) == (OK, '')
    given = numbers(value)
    simulator.apply(PlaceBody('sphere', {
        'position': given[4:7], 'orientation': given[:4], 'velocity': given[7:10],
        'angular_velocity': given[10:13]}))
    assert numbers(entity(paused)) == expected(simulator)
    assert ticks(paused) == 20
    call(paused, 'step_simulation', steps=30)
    simulator.advance_ticks(30)
    assert numbers(entity(paused)) == expected(simulator)


def test_an_anchor_is_put_elsewhere_with_a_velocity(paused):
    simulator = Simulator(SCENE)
    value = entity(paused, 'hand')
    value.pose.position.y, value.twist.linear.x = 0.1, 0.5
    assert put(paused, 'hand', value) == (OK, '')
    simulator.apply(SetValues({'hand.position': [0, 0.1, 2], 'hand.velocity': [0.5, 0, 0]}))
    assert paused.get('hand.position', 'hand.velocity') == [[0.0, 0.1, 2.0], [0.5, 0.0, 0.0]]
    call(paused, 'step_simulation', steps=10)
    simulator.advance_ticks(10)
    np.testing.assert_array_equal(xyz(entity(paused, 'hand').pose.position), [0.05, 0.1, 2.0])
    assert numbers(entity(paused)) == expected(simulator)


def changed(value, path, number):
    """Return an EntityState with one number, or a text, of it changed."""
    *owners, name = path.split('.')
    owner = value
    for one in owners:
        owner = getattr(owner, one)
    setattr(owner, name, number)
    return value


@pytest.mark.parametrize('name, path, number, code, text', [
    ('sphere', 'header.frame_id', 'map', FAILED, "frame 'map' is not known; give it in 'world'"),
    ('sphere', 'pose.position.x', float('nan'), INVALID_POSE,
     'sphere.position[0]: nan is not finite; give a number in m'),
    ('sphere', 'pose.position.x', 2e6, INVALID_POSE,
     'sphere.position[0]: 2000000 m is out of range: -1e+06 to 1e+06 m'),
    ('sphere', 'pose.orientation.w', 0.0, INVALID_POSE, 'is no orientation: its norm is '),
    ('sphere', 'twist.linear.z', float('inf'), FAILED,
     'sphere.velocity[2]: inf is not finite; give a number in m/s'),
    ('hand', 'pose.position.y', float('nan'), INVALID_POSE, 'hand.position[1]: nan is not finite'),
    ('hand', 'pose.orientation.x', 1.0, INVALID_POSE,
     'hand: orientation [1.0, 0.0, 0.0, 1.0] cannot be that of an anchor, which does not turn; '
     'give [0.0, 0.0, 0.0, 1.0]'),
    ('hand', 'twist.angular.x', 1.0, FAILED, 'hand: angular_velocity [1.0, 0.0, 0.0] cannot be '),
    ('hands', 'twist.linear.x', 1.0, NOT_FOUND,
     "entity: 'hands' is no body or anchor of this scene; did you mean 'hand'?")])
def test_refused_whole(paused, name, path, number, code, text):
    before = numbers(entity(paused)), numbers(entity(paused, 'hand'))
    value = entity(paused, 'hand' if name == 'hands' else name)
    # the rest could be set
    value.twist.linear.y = 3.0
    found, words = put(paused, name, changed(value, path, number))
    assert found == code and text in words, words
    assert (numbers(entity(paused)), numbers(entity(paused, 'hand'))) == before


def test_entities(paused):
    filters = types('msg').EntityFilters(filter='s.*')
    assert call(paused, 'get_entities').entities == ['sphere', 'hand']
    assert call(paused, 'get_entities', filters=filters).entities == ['sphere']
    found = call(paused, 'get_entities_states', filters=filters)
    assert found.entities == ['sphere']
    assert [numbers(one) for one in found.states] == [expected(Simulator(SCENE))]
    filters.filter = '('
    code, text = result(paused, 'get_entities', filters=filters)
    assert code == FAILED and 'is no POSIX extended regular expression' in text
    info = call(paused, 'get_entity_info', entity='sphere').info
    assert info.category.category == types('msg').EntityCategory.CATEGORY_DYNAMIC_OBJECT
    assert (info.description, list(info.tags)) == ('sphere, 1 kg', ['body', 'sphere'])
    for name in ('get_entity_info', 'get_entity_state'):
        assert result(paused, name, entity='earth')[0] == NOT_FOUND


@pytest.mark.parametrize('scope, time_is_reset, state_is_reset', [
    (TIME, True, False), (STATE, False, True), (TIME | STATE, True, True), (0, True, True),
    (255, True, True)])
def test_reset_by_scope(paused, scope, time_is_reset, state_is_reset):
    value = entity(paused, 'hand')
    value.pose.position.z = 2.1
    put(paused, 'hand', value)
    call(paused, 'step_simulation', steps=25)
    before, epochs = numbers(entity(paused)), len(paused.heard['epoch'])
    assert result(paused, 'reset_simulation', scope=scope) == (OK, '')
    assert (ticks(paused), state(paused)) == (0 if time_is_reset else 25, PAUSED)
    assert numbers(entity(paused)) == (expected(Simulator(SCENE)) if state_is_reset else before)
    assert paused.get('hand.position') == [[0.0, 0.0, 2.0 if state_is_reset else 2.1]]
    paused.drain()
    assert len(paused.heard['epoch']) - epochs == time_is_reset


@pytest.mark.parametrize('scope', [SPAWNED, 8])
def test_nothing_is_spawned(paused, scope):
    call(paused, 'step_simulation', steps=5)
    assert result(paused, 'reset_simulation', scope=scope) == (
        UNSUPPORTED, f'scope: {scope} is not supported, as nothing is spawned here; give '
                     'SCOPE_TIME (1), SCOPE_STATE (2) or both')
    assert ticks(paused) == 5


def test_all_of_it_is_recorded_and_can_be_lived_again(node, client):
    """By now, whatever the tests before have done."""
    change(client, PLAYING)
    put(client, 'sphere', entity(client))
    client.more('sphere/pose', 5)
    node.stop()
    found = []
    for path in node.bags:
        with open_bag(path) as bag:
            found.append(compare(RecordedRun(bag)))
    assert [outcome.difference for outcome in found] == [None] * len(found)
    assert sum(outcome.commands for outcome in found) >= 10


def test_after_divergence_and_quitting(standard_types, start, connect):
    node = start('-p', 'integrator:=rk4', '-p', 'spring.stiffness:=3e4', '-p', 'step:=0.01',
                 '-p', 'record.enable:=true')
    client = connect(node)
    client.wait(lambda: 'is no longer finite' in node.output, 120.0)
    assert state(client) == PAUSED
    code, text = change(client, PLAYING)
    assert code == NO_TRANSITION and text.endswith('; then call ~/reset')
    for name, fields in (('step_simulation', {'steps': 3}), ('reset_simulation', {'scope': TIME}),
                         ('reset_simulation', {'scope': STATE})):
        code, text = result(client, name, **fields)
        assert code == FAILED and text.endswith('; then call ~/reset'), text
    assert change(client, STOPPED) == (OK, '')
    assert (state(client), ticks(client)) == (STOPPED, 0)
    assert change(client, PLAYING) == (OK, '')
    assert change(client, QUITTING) == (OK, '')
    # it ends by itself, the bag of the last epoch finished and no other one begun
    assert node.wait().count('recording to ') == node.output.count('recorded ') == 2
