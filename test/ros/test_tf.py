# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Frames on /tf: recorded always, broadcast where tf2_msgs is installed.

PyPI has no tf2_msgs. In its place there is a package of that name whose TFMessage is another
type of message: what is compared are the bytes, which mean what they do under any type.
"""

import os

from live_node import with_parameters
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
import pytest
from rosbags.typesys import get_typestore, Stores
from scene_topics import MARKERS, POSE, xyz

JAZZY = get_typestore(Stores.ROS2_JAZZY)


@pytest.fixture(scope='module')
def client(start, connect, tmp_path_factory):
    folder = tmp_path_factory.mktemp('stand_in')
    (folder / 'tf2_msgs' / 'msg').mkdir(parents=True)
    (folder / 'tf2_msgs' / '__init__.py').touch()
    (folder / 'tf2_msgs' / 'msg' / '__init__.py').write_text(
        'from visualization_msgs.msg import MarkerArray as TFMessage\n')
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('PYTHONPATH', f'{folder}{os.pathsep}{os.environ["PYTHONPATH"]}')
        node = start('-r', '__ns:=/lab', name='/lab/dynsim')
    client = connect(node)
    client.listen({'/tf': MARKERS, 'sphere/pose': POSE})
    return client


def broadcast(data):
    """Return {stamp [ns]: {child frame: position and orientation}} of messages of /tf."""
    found = {}
    for part in (part for message in data for part in JAZZY.deserialize_cdr(
            message, 'tf2_msgs/msg/TFMessage').transforms):
        stamp = part.header.stamp.sec * 10 ** 9 + part.header.stamp.nanosec
        q = part.transform.rotation
        found.setdefault(stamp, {})[part.child_frame_id] = (
            *xyz(part.transform.translation), q.x, q.y, q.z, q.w)
    return found


def test_it_is_where_the_poses_are(client):
    client.wait(lambda: len(client.heard['/tf']) >= 5)
    client.pause()
    client.drain()
    found = broadcast(client.heard['/tf'])
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


@pytest.mark.parametrize('switch', [True, False])
def test_bags_have_it_without_tf2_msgs(start, switch):
    node = start(*with_parameters({'record.enable': 'true', 'duration': 0.4,
                                   'real_time_factor': 0.0, 'publish_tf': str(switch).lower()}),
                 '-r', '__ns:=/recorded')
    node.wait()
    with open(node.bags[0], 'rb') as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        found = [(message.log_time, [part.child_frame_id for part in decoded.transforms])
                 for *_, message, decoded in reader.iter_decoded_messages(topics=['/tf'])]
    frames = ['recorded/dynsim/sphere', 'recorded/dynsim/hand']
    assert found == [(time, frames) for time in range(0, 400_000_001, 40_000_000)] * switch
