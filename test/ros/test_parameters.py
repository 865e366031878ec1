# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters through the standard services of a running node."""

import math

import numpy as np
import pytest
from rcl_interfaces.msg import ParameterType
from rclpy.parameter import Parameter
from ros_client import stamps
from scene_topics import forces, SPHERE

QUANTITIES = {
    'gravity': 'm/s^2', 'down': '', 'air.linear_drag': 'N s/m', 'air.rotational_drag': 'N m s/rad',
    'air.velocity': 'm/s', 'air.angular_velocity': 'rad/s', 'hand.position': 'm',
    'hand.velocity': 'm/s', 'sphere.mass': 'kg', 'sphere.radius': 'm', 'spring.stiffness': 'N/m',
    'spring.damping': 'N s/m', 'spring.natural_length': 'm'}
INITIAL = {'sphere.position': 'm', 'sphere.velocity': 'm/s', 'sphere.orientation': '',
           'sphere.angular_velocity': 'rad/s'}
SETTINGS = {'rate': 'Hz', 'step': 's', 'tolerance': '', 'wrench_timeout': 's'}
OTHERS = {'integrator', 'anchor_interpolation', 'scene', 'real_time_factor', 'publish_clock',
          'duration', 'publish_rate.state', 'publish_rate.wrench', 'publish_rate.energy',
          'publish_wrenches', 'publish_tf', 'step_count', 'step_until', 'state.file', 'state.time',
          'record.enable', 'record.directory', 'record.compression', 'record.max_size',
          'record.max_duration', 'record.sync',
          'real_time.spin', 'real_time.priority', 'real_time.cpu', 'real_time.lock_memory',
          'use_sim_time'}


@pytest.fixture(scope='module')
def node(start):
    return start()


@pytest.fixture(scope='module')
def client(node, connect):
    client = connect(node)
    client.listen(SPHERE)
    client.more('sphere/pose')
    client.pause()
    return client


@pytest.fixture(autouse=True)
def initial_scene(client):
    client.reset()
    client.clear()


def test_every_quantity_is_there(client):
    names = {name for name in client.parameter_names()
             if not name.startswith(('qos_overrides.', 'start_type_description'))}
    assert {*QUANTITIES, *INITIAL, *SETTINGS, *OTHERS} <= names
    # offsets of a spring's ends are quantities too, where a scene gives them
    assert names - {*QUANTITIES, *INITIAL, *SETTINGS, *OTHERS} <= {
        'spring.from_offset', 'spring.to_offset'}


@pytest.mark.parametrize(('name', 'unit'), [*{**QUANTITIES, **SETTINGS, **INITIAL}.items()])
def test_descriptor(client, name, unit):
    (descriptor,) = client.describe(name)
    assert descriptor.name == name
    assert (f'[{unit}]' if unit else descriptor.description) in descriptor.description
    assert descriptor.read_only == (name in INITIAL)
    assert descriptor.type in (ParameterType.PARAMETER_DOUBLE,
                               ParameterType.PARAMETER_DOUBLE_ARRAY)
    if descriptor.type == ParameterType.PARAMETER_DOUBLE:
        (span,) = descriptor.floating_point_range
        assert span.from_value < span.to_value and span.step == 0.0
    else:
        assert ' numbers, each ' in descriptor.additional_constraints


@pytest.mark.parametrize('name', sorted(OTHERS - {'use_sim_time'}))
def test_every_other_one_is_described_too(client, name):
    assert client.describe(name)[0].description


def test_the_range_is_the_one_that_holds(client):
    (descriptor,) = client.describe('sphere.mass')
    (span,) = descriptor.floating_point_range
    for value in (span.from_value, span.to_value):
        assert client.configure({'sphere.mass': value})[0].successful
    for value in (0.99 * span.from_value, 1.01 * span.to_value):
        assert not client.configure({'sphere.mass': value})[0].successful


def test_one_changes_the_motion_from_the_next_tick_on(client):
    client.steps(1, 'sphere/pose')
    assert client.configure({'gravity': 1.62})[0].successful
    client.steps(1, 'sphere/pose')
    weights = forces(client.messages('sphere/wrench/gravity'))
    assert weights.tolist() == [[0.0, 0.0, -9.81], [0.0, 0.0, -1.62]]


def test_integer_counts_as_number(client):
    assert client.configure({'sphere.mass': 3, 'hand.position': [1, 0, 2]}) == client.configure(
        {'sphere.mass': 3.0, 'hand.position': [1.0, 0.0, 2.0]})
    assert list(client.get('sphere.mass')) == [3.0]
    client.steps(1, 'sphere/pose')
    assert forces([client.last('sphere/wrench/gravity')])[0, 2] == pytest.approx(-3 * 9.81)


def test_group_is_set_whole(client):
    assert client.set_group({'sphere.mass': 2.0, 'gravity': 3.0, 'down': [1.0, 0.0, 0.0],
                             'spring.stiffness': 0.0}).successful
    client.steps(1, 'sphere/pose')
    assert forces([client.last('sphere/wrench/gravity')]).tolist() == [[6.0, 0.0, 0.0]]
    assert not forces([client.last('sphere/wrench/spring')]).any()


def test_one_by_one_those_that_are_right_are_set(client):
    results = client.configure({'sphere.mass': 2.0, 'gravity': math.nan, 'spring.damping': 1.0})
    assert [result.successful for result in results] == [True, False, True]
    assert client.get('sphere.mass', 'gravity', 'spring.damping') == [2.0, 9.81, 1.0]


def test_what_is_told_is_what_is_in_force(client):
    assert client.configure({'down': [0.0, 0.0, -2.0]})[0].successful
    assert list(client.get('down')[0]) == [0.0, 0.0, -1.0]


def test_anchor_by_parameter(client):
    assert client.configure({'hand.position': [0.5, 0.0, 2.0], 'hand.velocity': [0.0, 1.0, 0.0]})
    xs = [message.pose.position for message in client.steps(3, 'hand/pose')]
    assert [x.x for x in xs] == [0.5] * 3
    np.testing.assert_allclose([x.y for x in xs], [0.01, 0.02, 0.03], atol=1e-15)


def test_rate_changes_the_distance_of_stamps(client):
    client.steps(2, 'sphere/pose')
    assert client.configure({'rate': 250.0})[0].successful
    messages = client.steps(3, 'sphere/pose')
    assert stamps(messages) == [24_000_000, 28_000_000, 32_000_000]


@pytest.mark.parametrize('method', ['explicit_euler', 'explicit_euler_axis_angle',
                                    'semi_implicit_euler', 'linearly_implicit_euler', 'leapfrog',
                                    'rk4', 'auto'])
def test_integrator_can_change_on_the_way(client, method):
    client.steps(1, 'sphere/pose')
    assert client.set_group({'integrator': method, 'step': 1e-4}).successful
    poses = client.steps(3, 'sphere/pose')
    client.reset()
    client.drain()
    expected = client.steps(4, 'sphere/pose')[1:]
    for ours, theirs in zip(poses, expected):
        a, b = ours.pose.position, theirs.pose.position
        assert (a.x, a.y, a.z) == pytest.approx((b.x, b.y, b.z), abs=2e-4)


def test_parameter_by_topic(client):
    client.publish('parameter_command', Parameter('gravity', value=0.5).to_parameter_msg())
    client.wait(lambda: client.get('gravity') == [0.5])
    client.steps(1, 'sphere/pose')
    assert forces([client.last('sphere/wrench/gravity')])[0, 2] == -0.5
    client.publish('parameter_command', Parameter('gravity', value=2).to_parameter_msg())
    client.wait(lambda: client.get('gravity') == [2.0])
