# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bags to test with: a falling body's pose and speed, with a remark now and then."""

from dynsim_ros.bag.writer import BagWriter
from dynsim_ros.messages.cdr import encode
from dynsim_ros.messages.definitions import definition
from dynsim_ros.messages.qos import LATCHED, STATE
from mcap.writer import IndexType, Writer

TOPICS = {
    '/sample/pose': ('geometry_msgs/msg/PoseStamped', STATE),
    '/sample/twist': ('geometry_msgs/msg/TwistStamped', STATE),
    '/sample/epoch': ('std_msgs/msg/UInt64', LATCHED),
}
STEP = 10_000_000  # ns
# Options of mcap.Writer.
KINDS_OF_MCAP = [
    {}, {'use_chunking': False}, {'index_types': IndexType.NONE},
    {'index_types': IndexType.CHUNK}, {'repeat_channels': False, 'repeat_schemas': False},
    {'use_statistics': False}, {'use_summary_offsets': False}, {'enable_crcs': False},
    {'use_statistics': False, 'repeat_channels': False, 'repeat_schemas': False,
     'use_summary_offsets': False, 'index_types': IndexType.NONE},
]


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


def write_foreign(path, messages, profiles=None, **options):
    """Write messages with the plain MCAP writer; `profiles` adds a channel for each."""
    options.setdefault('chunk_size', 1000)
    with open(path, 'wb') as stream:
        writer = Writer(stream, **options)
        writer.start('ros2')
        channels = {}
        for topic, (type_name, _) in TOPICS.items():
            schema = writer.register_schema(
                type_name, 'ros2msg', definition(type_name).text.encode())
            channels[topic] = [
                writer.register_channel(topic, 'cdr', schema, {'offered_qos_profiles': profile})
                for profile in profiles or ['']]
        for number, (topic, stamp, data) in enumerate(messages):
            channel = channels[topic][number % len(channels[topic])]
            writer.add_message(channel, stamp, data, stamp)
        writer.add_metadata('note', {'a': 'b'})
        writer.add_attachment(0, 0, 'x.txt', 'text/plain', b'x')
        writer.finish()
