# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Namespaces, other names, other qualities of service; two nodes side by side."""

from geometry_msgs.msg import PointStamped
from mcap.reader import make_reader
import pytest
from rclpy.qos import ReliabilityPolicy
from scene_topics import DIAGNOSTICS, POSE, positions
from std_srvs.srv import SetBool


@pytest.fixture(scope='module')
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp('both')


@pytest.fixture(scope='module')
def left(start, folder):
    return start(
        '-r', '__ns:=/left', '-p', 'record.enable:=true',
        '-p', 'qos_overrides./left/dynsim/sphere/pose.publisher.depth:=3',
        '-p', 'qos_overrides./left/dynsim/hand/pose.publisher.reliability:=best_effort',
        folder=folder, name='/left/dynsim')


@pytest.fixture(scope='module')
def right(start, folder):
    return start(
        '-r', '__ns:=/right/hand', '-r', '__node:=model', '-p', 'record.enable:=true',
        '-r', '~/sphere/pose:=/tracked', '-r', '~/hand/command:=/clicked_point',
        folder=folder, name='/right/hand/model')


@pytest.fixture(scope='module')
def clients(left, right, connect):
    of_left, of_right = connect(left), connect(right)
    of_left.listen({'sphere/pose': POSE, 'sphere/twist': 'geometry_msgs/msg/TwistStamped'})
    of_right.listen({'/tracked': POSE, 'hand/pose': POSE, '/diagnostics': DIAGNOSTICS})
    of_left.more('sphere/pose')
    of_right.more('/tracked')
    return of_left, of_right


def test_all_is_below_the_name(clients, right):
    node = clients[0].node
    topics = {name for name, _ in node.get_publisher_names_and_types_by_node(
        'model', '/right/hand')}
    assert {name for name in topics if not name.startswith('/right/hand/model/')} == {
        '/tracked', '/diagnostics', '/rosout', '/parameter_events'}
    services = {name for name, _ in node.get_service_names_and_types_by_node(
        'model', '/right/hand')}
    assert {f'/right/hand/model/{name}'
            for name in ('pause', 'step', 'reset', 'record')} <= services
    assert all(name.startswith('/right/hand/model/') for name in services)
    taken = dict(node.get_subscriber_names_and_types_by_node('model', '/right/hand'))
    assert '/clicked_point' in taken and '/right/hand/model/hand/command' not in taken


def test_overridden_quality_of_service(clients):
    of_left = clients[0]
    (info,) = of_left.node.get_publishers_info_by_topic('/left/dynsim/hand/pose')
    assert info.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT
    (info,) = of_left.node.get_publishers_info_by_topic('/left/dynsim/sphere/pose')
    assert info.qos_profile.reliability == ReliabilityPolicy.RELIABLE
    # DDS does not tell others the depth; the node's parameter does
    assert of_left.get('qos_overrides./left/dynsim/sphere/pose.publisher.depth',
                       'qos_overrides./left/dynsim/sphere/twist.publisher.depth') == [3, 1000]


def test_each_has_commands_and_services_of_its_own(clients):
    of_left, of_right = clients
    assert of_left.pause().success
    of_right.more('/tracked', 5)
    of_right.pause()
    of_left.drain()
    of_right.drain()
    command = PointStamped()
    command.point.x, command.point.z = 0.7, 2.0
    of_right.publish('/clicked_point', command)
    of_right.drain()
    assert positions(of_right.steps(1, 'hand/pose')).tolist() == [[0.7, 0.0, 2.0]]
    assert of_left.configure({'sphere.mass': 2.0})[0].successful
    assert (of_left.get('sphere.mass'), of_right.get('sphere.mass')) == ([2.0], [1.0])


def test_diagnostics_tell_them_apart(clients):
    of_right = clients[1]
    of_right.wait(lambda: {status.name for array in of_right.messages('/diagnostics')
                           for status in array.status} >= {'dynsim: run', 'model: run'})


def test_each_records_its_own_file(clients, left, right):
    for client in clients:
        assert client.record(False).success
    assert len(left.bags) == 2
    nodes = {}
    for path in left.bags:
        with open(path, 'rb') as stream:
            reader = make_reader(stream)
            topics = {channel.topic for channel in reader.get_summary().channels.values()}
            (run,) = [record.metadata for record in reader.iter_metadata()
                      if record.name == 'dynsim_ros']
        nodes[run['node']] = topics
    assert set(nodes) == {'/left/dynsim', '/right/hand/model'}
    assert '/left/dynsim/sphere/pose' in nodes['/left/dynsim']
    # remapped topics are recorded under the names that they have
    assert {'/tracked', '/clicked_point'} <= nodes['/right/hand/model']
    assert '/right/hand/model/sphere/pose' not in nodes['/right/hand/model']


def test_names_chosen_at_the_same_moment(clients, left):
    """Let both begin a file in one second, many times."""
    before = len(left.bags)
    for number in range(5):
        for data in (True, False):
            futures = [client.call_async('record', SetBool, data=data) for client in clients]
            for client, future in zip(clients, futures):
                client.wait(future.done)
                assert future.result().success, (number, future.result().message)
    assert len(left.bags) == before + 10
