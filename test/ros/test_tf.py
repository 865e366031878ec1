# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Frames on /tf: recorded always, broadcast where tf2_msgs is installed."""

from mcap.reader import make_reader
import pytest
from scene_topics import POSE, xyz

# Building the type takes long on a busy machine.
pytestmark = pytest.mark.timeout(400)
TF = 'tf2_msgs/msg/TFMessage'


@pytest.fixture(scope='module')
def node(tf2_types, start):
    return start('-r', '__ns:=/lab', name='/lab/dynsim')


@pytest.fixture(scope='module')
def client(node, connect):
    client = connect(node)
    client.listen({'/tf': TF, 'sphere/pose': POSE})
    return client


def broadcast(messages):
    """Return {stamp [ns]: {child frame: position and orientation}} of messages of /tf."""
    found = {}
    for part in (part for message in messages for part in message.transforms):
        stamp = part.header.stamp.sec * 10 ** 9 + part.header.stamp.nanosec
        q = part.transform.rotation
        assert part.header.frame_id == 'world'
        found.setdefault(stamp, {})[part.child_frame_id] = (
            *xyz(part.transform.translation), q.x, q.y, q.z, q.w)
    return found


def test_it_is_where_the_poses_are(client):
    client.wait(lambda: len(client.heard['/tf']) >= 5)
    client.pause()
    client.drain()
    found = broadcast(client.messages('/tf'))
    poses = {}
    for message in client.messages('sphere/pose'):
        q, stamp = message.pose.orientation, message.header.stamp
        poses[stamp.sec * 10 ** 9 + stamp.nanosec] = (
            *xyz(message.pose.position), q.x, q.y, q.z, q.w)
    # at every fourth tick of 10 ms, as the markers
    times = sorted(found)
    assert times == list(range(times[0], times[-1] + 1, 40_000_000))
    shared = [time for time in times if time in poses]
    assert len(shared) >= 4
    for time in shared:
        assert found[time]['lab/dynsim/sphere'] == poses[time]
        assert found[time]['lab/dynsim/hand'] == (0, 0, 2, 0, 0, 0, 1)


def test_it_can_be_switched_off(client):
    client.pause()
    for switch, expected in ((False, 0), (True, 2)):
        assert client.configure({'publish_tf': switch})[0].successful
        client.clear()
        client.steps(8, 'sphere/pose')
        assert len(client.heard['/tf']) == expected


def test_bags_have_it_too(client, node):
    """Also where tf2_msgs is not installed: see test_bag_of_live_run.py."""
    client.record(True)
    assert client.configure({'publish_tf': False})[0].successful
    client.steps(8, 'sphere/pose')
    assert client.configure({'publish_tf': True})[0].successful
    client.clear()
    client.steps(8, 'sphere/pose')
    client.record(False)
    with open(node.bags[0], 'rb') as stream:
        entries = list(make_reader(stream).iter_messages(['/tf']))
    found = [message.data for *_, message in entries]
    # what was there at the beginning, and the two that were broadcast
    assert found[-2:] == client.heard['/tf'] and len(found) <= 3
    # the definition that is shipped is that of the type that is broadcast
    (publisher,) = client.node.get_publishers_info_by_topic('/tf')
    _, channel, _ = entries[0]
    assert str(publisher.topic_type_hash) == channel.metadata['topic_type_hash']
