# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters that a running node refuses: with a reason, and nothing changes."""

import math

import pytest
from rcl_interfaces.msg import Parameter as ParameterMessage, ParameterValue
from rcl_interfaces.srv import SetParameters
from rclpy.parameter import Parameter
from scene_topics import forces, SPHERE


@pytest.fixture(scope='module')
def client(start, connect):
    client = connect(start())
    client.listen(SPHERE)
    client.more('sphere/pose')
    client.pause()
    return client


@pytest.fixture(autouse=True)
def initial_scene(client):
    client.reset()
    client.clear()


@pytest.mark.parametrize('wrong', [
    {'spring.stiffness': -5.0}, {'spring.stiffness': 'stiff'}, {'no.such.thing': 1.0},
    {'integrator': 'rk5'}, {'scene': 'two_anchors'}, {'record.compression': 'zip'},
    {'rate': 0.0}, {'sphere.position': [0.0, 0.0, 0.0]}, {'real_time_factor': -1.0},
    {'hand.position': [0.0, 0.0]}, {'use_sim_time': 'yes'},
    {'use_sim_time': True, 'publish_clock': True}])
def test_group_is_refused_whole(client, wrong):
    names = client.parameter_names()
    before = client.get(*names)
    for values in ({'sphere.mass': 2.0, **wrong}, {**wrong, 'sphere.mass': 2.0}):
        result = client.set_group(values)
        assert not result.successful and result.reason
    assert client.get(*names) == before
    client.steps(1, 'sphere/pose')
    assert forces([client.last('sphere/wrench/gravity')]).tolist() == [[0.0, 0.0, -9.81]]


@pytest.mark.parametrize(('name', 'value', 'reason'), [
    ('spring.stiffness', -1.0, 'spring.stiffness: -1 N/m is out of range: 0 to 1e+12 N/m'),
    ('spring.stiffness', math.nan, 'spring.stiffness: nan is not finite; give a number in N/m'),
    ('sphere.mass', math.inf, 'sphere.mass: inf is not finite; give a number in kg'),
    ('sphere.mass', 0, 'sphere.mass: 0 kg is out of range: 1e-09 to 1e+06 kg'),
    ('sphere.mass', '2', "sphere.mass: '2' is a text; give a number"),
    ('sphere.mass', True, 'sphere.mass: True is not a number; give a number in kg'),
    ('sphere.mass', [1.0], 'sphere.mass: [1.0] is not a number; give a number in kg'),
    ('hand.position', [0.0, math.nan, 0.0],
     'hand.position[1]: nan is not finite; give a number in m'),
    ('hand.position', [0.0, 0.0, 2e6],
     'hand.position[2]: 2000000 m is out of range: -1e+06 to 1e+06 m'),
    ('hand.position', 2.0, 'hand.position: 2.0 is not a list of 3 numbers in m'),
    ('down', [0.0, 0.0, 0.0], 'down: [0.0, 0.0, 0.0] has no direction'),
    ('rate', 20_000.0, 'rate: 20000 Hz is out of range: 0.1 to 10000 Hz'),
    ('integrator', 'rk5', "integrator: 'rk5' is not known; did you mean 'rk4'?"),
    ('anchor_interpolation', 'cubic', "'cubic' is not known; known are: hold, linear"),
    ('record.compression', 'zip', "'zip' is not known; known are: lz4, none, zstd"),
    ('real_time_factor', -0.5, 'real_time_factor: -0.5 is out of range: 0 to 1000'),
    ('duration', math.nan, 'duration: nan is not finite; give a number in s'),
    ('sphere.mas', 1.0, "parameter 'sphere.mas' is not known; did you mean 'sphere.mass'?"),
    ('sphere.position', [0.0, 0.0, 1.0], 'is an initial condition, fixed once the run has begun'),
    ('scene', 'two_anchors', 'read-only parameter: scene'),
    ('record.enable', True, 'read-only parameter: record.enable'),
])
def test_one_is_refused_with_a_reason(client, name, value, reason):
    (result,) = client.configure({name: value})
    assert not result.successful
    assert reason in result.reason and '\n' not in result.reason


def test_nothing_takes_a_value_away(client):
    before = client.get('sphere.mass', 'scene', 'use_sim_time')
    for name in ('sphere.mass', 'scene', 'use_sim_time'):
        assert not client.configure({name: Parameter(name).value})[0].successful
    assert client.get('sphere.mass', 'scene', 'use_sim_time') == before


def test_a_request_that_rclpy_cannot_read_ends_nothing(client):
    unreadable = ParameterMessage(name='sphere.mass', value=ParameterValue(type=42))
    client.call_async('set_parameters', SetParameters, parameters=[unreadable])
    assert client.configure({'sphere.mass': 2.0})[0].successful
    client.steps(1, 'sphere/pose')
    assert forces([client.last('sphere/wrench/gravity')]).tolist() == [[0.0, 0.0, -2.0 * 9.81]]
