# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What RViz and Foxglove draw: bodies whose orientation can be seen, anchors, springs."""

import numpy as np
import pytest
from ros_client import nanoseconds
from scene_topics import MARKERS, POSE, RADIUS, xyz
from scipy.spatial.transform import Rotation
from visualization_msgs.msg import Marker


@pytest.fixture(scope='module')
def drawn(start, connect):
    """Give ({namespace: markers}, pose of the sphere, pose of the hand) of one instant."""
    client = connect(start())
    client.listen({'markers': MARKERS, 'sphere/pose': POSE, 'hand/pose': POSE})
    client.more('markers', 2)
    client.pause()
    client.drain()
    array = client.last('markers')
    stamp = nanoseconds(array.markers[0].header.stamp)
    same_time = [next(pose for pose in client.messages(topic)
                      if nanoseconds(pose.header.stamp) == stamp)
                 for topic in ('sphere/pose', 'hand/pose')]
    spaces = {}
    for marker in array.markers:
        assert (marker.header.frame_id, nanoseconds(marker.header.stamp)) == ('world', stamp)
        assert marker.action == Marker.ADD and marker.color.a == pytest.approx(1.0, abs=0.5)
        spaces.setdefault(marker.ns, []).append(marker)
    return spaces, *same_time


def test_each_marker_has_an_identity(drawn):
    markers = [marker for markers in drawn[0].values() for marker in markers]
    assert len({(marker.ns, marker.id) for marker in markers}) == len(markers)


def test_the_body_is_where_its_pose_is(drawn):
    spaces, pose, _ = drawn
    (sphere,) = [marker for marker in spaces['bodies'] if marker.type == Marker.SPHERE]
    assert sphere.pose == pose.pose
    assert list(xyz(sphere.scale)) == [2 * RADIUS] * 3


def test_the_axes_turn_with_the_body(drawn):
    spaces, pose, _ = drawn
    (axes,) = [marker for markers in spaces.values() for marker in markers
               if marker.type == Marker.LINE_LIST]
    q = axes.pose.orientation
    turn = Rotation.from_quat((q.x, q.y, q.z, q.w))
    points = turn.apply([xyz(point) for point in axes.points]) + xyz(axes.pose.position)
    p = pose.pose.orientation
    expected = Rotation.from_quat((p.x, p.y, p.z, p.w)).as_matrix()
    for number in range(3):
        begin, end = points[2 * number:2 * number + 2]
        np.testing.assert_allclose(begin, xyz(pose.pose.position), atol=1e-12)
        assert np.linalg.norm(end - begin) > RADIUS, 'hidden in the sphere'
        np.testing.assert_allclose((end - begin) / np.linalg.norm(end - begin),
                                   expected[:, number], atol=1e-9)


def test_the_anchor_and_the_spring(drawn):
    spaces, pose, hand = drawn
    (anchor,) = spaces['anchors']
    np.testing.assert_array_equal(xyz(anchor.pose.position), xyz(hand.pose.position))
    (spring,) = spaces['springs']
    p = pose.pose.orientation
    edge = xyz(pose.pose.position) + Rotation.from_quat((p.x, p.y, p.z, p.w)).apply(
        (0.0, 0.0, RADIUS))
    np.testing.assert_allclose(xyz(spring.points[0]), xyz(hand.pose.position), atol=1e-9)
    np.testing.assert_allclose(xyz(spring.points[-1]), edge, atol=1e-9)


def test_they_follow_what_is_set(start, connect):
    client = connect(start('-r', '__ns:=/bigger', name='/bigger/dynsim'))
    client.listen({'markers': MARKERS})
    assert client.configure({'sphere.radius': 0.5})[0].successful
    client.more('markers', 3)
    (sphere,) = [marker for marker in client.last('markers').markers
                 if marker.type == Marker.SPHERE]
    assert list(xyz(sphere.scale)) == [1.0] * 3
