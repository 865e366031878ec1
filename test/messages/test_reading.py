# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers out of the bytes of commands, as rclpy and rosbags serialise them."""

from dynsim_ros.messages.reading import Reading
from geometry_msgs.msg import PointStamped, WrenchStamped
import pytest
from rclpy.serialization import serialize_message
from rosbags.typesys import get_typestore, Stores

POINT = 'geometry_msgs/msg/PointStamped'
WRENCH = 'geometry_msgs/msg/WrenchStamped'
POINT_LEAVES = ('point.x', 'point.y', 'point.z')
WRENCH_LEAVES = ('wrench.force.x', 'wrench.force.z', 'wrench.torque.y')
# expected, as long as one that is, and others of all alignments
FRAMES = ['world', '', 'wOrld', 'w', 'map', 'worlds', 'a/b/c/d', 'größer']


def point(frame='world'):
    message = PointStamped()
    message.header.frame_id = frame
    message.header.stamp.sec, message.header.stamp.nanosec = -7, 123_456_789
    message.point.x, message.point.y, message.point.z = 1.5, -0.0, 1e-300
    return message


@pytest.mark.parametrize('frame', FRAMES)
def test_point(frame):
    found = Reading(POINT, POINT_LEAVES, ('world', ''))(serialize_message(point(frame)))
    assert found == (frame, (1.5, -0.0, 1e-300))


@pytest.mark.parametrize('frame', FRAMES)
def test_some_numbers_of_a_wrench(frame):
    message = WrenchStamped()
    message.header.frame_id = frame
    message.wrench.force.x, message.wrench.force.z, message.wrench.torque.y = 1.0, 2.0, 3.0
    found = Reading(WRENCH, WRENCH_LEAVES, ('world', ''))(serialize_message(message))
    assert found == (frame, (1.0, 2.0, 3.0))


@pytest.mark.parametrize('frame', ['world', 'map'])
def test_other_byte_order(frame):
    store = get_typestore(Stores.ROS2_JAZZY)
    data = serialize_message(point(frame))
    big = bytes(store.serialize_cdr(store.deserialize_cdr(data, POINT), POINT,
                                    little_endian=False))
    assert big != data
    assert Reading(POINT, POINT_LEAVES, ('world', ''))(big) == (frame, (1.5, -0.0, 1e-300))


@pytest.mark.parametrize('frame', ['world', 'map'])
def test_what_is_cut_off(frame):
    data, reading = serialize_message(point(frame)), Reading(POINT, POINT_LEAVES, ('world', ''))
    for size in range(len(data)):
        with pytest.raises(ValueError, match=POINT):
            reading(data[:size])
