# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bags to test with: a falling body's pose and speed, with a remark now and then."""

from dynsim_ros.bag.writer import BagWriter
from dynsim_ros.messages.cdr import encode
from dynsim_ros.messages.qos import LATCHED, STATE

TOPICS = {
    '/sample/pose': ('geometry_msgs/msg/PoseStamped', STATE),
    '/sample/twist': ('geometry_msgs/msg/TwistStamped', STATE),
    '/sample/epoch': ('std_msgs/msg/UInt64', LATCHED),
}
STEP = 10_000_000  # ns


def sample_messages(count=100, step=STEP):
    """Return (topic, time in ns, CDR bytes) of `count` instants, one remark at the beginning."""
    messages = [('/sample/epoch', 0, encode('std_msgs/msg/UInt64', {'data': 1}))]
    for number in range(count):
        stamp = number * step
        header = {'stamp': {'sec': stamp // 10 ** 9, 'nanosec': stamp % 10 ** 9},
                  'frame_id': 'world'}
        height = -4.905 * (stamp * 1e-9) ** 2
        messages.append(('/sample/pose', stamp, encode('geometry_msgs/msg/PoseStamped', {
            'header': header, 'pose': {'position': {'z': height}}})))
        messages.append(('/sample/twist', stamp, encode('geometry_msgs/msg/TwistStamped', {
            'header': header, 'twist': {'linear': {'z': -9.81 * stamp * 1e-9}}})))
    return messages


def write_sample(path, count=100, step=STEP, **options):
    """Write a bag and return its messages."""
    messages = sample_messages(count, step)
    with BagWriter(path, library='dynsim_ros test', **options) as writer:
        channels = {topic: writer.add_channel(topic, *what) for topic, what in TOPICS.items()}
        writer.add_attachment('scene.yaml', b'gravity: 9.81\n', 'application/yaml')
        writer.add_metadata('settings', {'rate': '100', 'integrator': 'rk4'})
        for topic, stamp, data in messages:
            writer.write(channels[topic], stamp, data)
    return messages
