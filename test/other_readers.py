# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bags as programs of others read them."""

from dynsim_ros.bag.records import HEAD, MAGIC, parts
from mcap.reader import make_reader
from rosbags.rosbag2.storage_mcap import McapReader


def by_mcap(path):
    """Return (topic, time, data) as mcap reads them, and how many its summary tells of."""
    with open(path, 'rb') as stream:
        reader = make_reader(stream, validate_crcs=True)
        messages = [(channel.topic, message.log_time, message.data)
                    for _, channel, message in reader.iter_messages(log_time_order=False)]
        return messages, reader.get_summary().statistics.message_count


def by_rosbags(path):
    """Return (topic, time, data) as rosbags reads them."""
    reader = McapReader(path)
    reader.open()
    try:
        return [(connection.topic, stamp, bytes(data)) for connection, stamp, data
                in reader.messages(reader.connections, 0, 2 ** 62)]
    finally:
        reader.close()


def places(content, opcode):
    """Return first byte and end of the records of a kind."""
    return [(len(MAGIC) + start - HEAD.size, len(MAGIC) + end)
            for kind, start, end in parts(content[len(MAGIC):-len(MAGIC)]) if kind == opcode]
