# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Commands by topic that cannot be carried out: a warning, a count, and nothing else."""

import math

from geometry_msgs.msg import PointStamped, WrenchStamped
import pytest
from rcl_interfaces.msg import Parameter, ParameterValue
from rclpy.serialization import serialize_message
from scene_topics import DIAGNOSTICS, SPHERE

DOUBLE, TEXT, NO_SUCH_TYPE = 3, 4, 42


@pytest.fixture(scope='module')
def node(start):
    return start()


@pytest.fixture(scope='module')
def client(node, connect):
    client = connect(node)
    client.listen({**SPHERE, '/diagnostics': DIAGNOSTICS})
    client.more('sphere/pose')
    client.pause()
    return client


def point(x=0.0, frame='world'):
    command = PointStamped()
    command.header.frame_id = frame
    command.point.x = x
    return 'hand/command', command


def wrench(force=0.0, torque=0.0, frame='world'):
    command = WrenchStamped()
    command.header.frame_id = frame
    command.wrench.force.z, command.wrench.torque.y = force, torque
    return 'sphere/wrench_command', command


def cut_off(command):
    """Return a command as bytes whose end is missing, as no well-behaved program sends them."""
    topic, message = command
    return topic, serialize_message(message)[:-8]


def parameter(name, kind, **value):
    return 'parameter_command', Parameter(name=name, value=ParameterValue(type=kind, **value))


WITH_WARNING = [
    (point(frame='map'), "frame 'map' is not known; give it in 'world'"),
    (cut_off(point()), 'geometry_msgs/msg/PointStamped: the data end after 44 bytes, within or '
     'before geometry_msgs/msg/PointStamped.point.z'),
    (point(math.nan), 'hand: position[0]: nan is not finite; give a number in m'),
    (wrench(-2e9), 'sphere: force[2]: -2e+09 N is out of range: -1e+09 to 1e+09 N'),
    (parameter('spring.stiffnes', DOUBLE, double_value=1.0),
     "parameter 'spring.stiffnes' is not known; did you mean 'spring.stiffness'?"),
]
WRONG = [command for command, _ in WITH_WARNING] + [
    point(-math.inf),
    point(1e7),
    cut_off(point()),
    cut_off(point(frame='map')),
    cut_off(wrench()),
    wrench(frame='sphere'),
    wrench(math.inf),
    wrench(0.0, math.nan),
    parameter('spring.stiffness', DOUBLE, double_value=-1.0),
    parameter('spring.stiffness', DOUBLE, double_value=math.nan),
    parameter('spring.stiffness', TEXT, string_value='7'),
    parameter('spring.stiffness', NO_SUCH_TYPE),
    parameter('sphere.position', DOUBLE, double_value=1.0),
    parameter('', DOUBLE),
]


def told(client):
    """Return {key: value} of the run in the next diagnostics."""
    (array, *_) = client.more('/diagnostics')
    return {item.key: item.value for item in array.status[0].values}


def everything(client):
    """Return parameters and, as bytes, all that the first tick of a run publishes."""
    client.clear()
    client.steps(1, 'sphere/pose')
    return (client.get(*client.parameter_names()),
            {topic: client.heard[topic][-1] for topic in SPHERE if topic != 'markers'})


def test_the_reason_is_in_the_log(node, client):
    for (topic, command), reason in WITH_WARNING:
        before = len(node.output)
        # warnings are throttled to one a second: repeat it until one is due again
        client.wait(lambda topic=topic, command=command, before=before: (
            client.publish(topic, command) or client.drain() or node.output[before:]))
        warning = node.output[before:]
        assert '[WARN] ' in warning and f'[dynsim]: ~/{topic} refused: {reason}' in warning
        assert len(warning.splitlines()) == 1


def test_nothing_changes_and_each_is_counted(client):
    client.reset()
    expected = everything(client)
    client.reset()
    count = int(told(client)['commands refused'])
    for topic, command in WRONG:
        client.publish(topic, command)
        client.drain()
    client.wait(lambda: int(told(client)['commands refused']) == count + len(WRONG))
    assert everything(client) == expected


def test_a_flood_of_them_gives_few_warnings(node, client):
    before = len(node.output)
    count = int(told(client)['commands refused'])
    for _ in range(1000):
        client.publish(*point(math.nan))
    client.wait(lambda: int(told(client)['commands refused']) >= count + 10)
    assert len(node.output[before:].splitlines()) <= 4
    assert client.pause().success
