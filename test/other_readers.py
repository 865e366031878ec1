# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bags as programs of others read them."""

from dynsim_ros.bag.records import HEAD, MAGIC, parts
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
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


def by_mcap_ros2(path):
    """Return [topic, time, message as nested plain values] as mcap-ros2-support decodes them."""
    with open(path, 'rb') as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        return [[channel.topic, message.log_time, fields(decoded)] for _, channel, message, decoded
                in reader.iter_decoded_messages(log_time_order=False)]


def fields(message):
    """Return a message of any library as nested plain values."""
    slots = getattr(message, 'get_fields_and_field_types', None)
    names = slots() if slots else getattr(message, '__slots__', None)
    if names is not None and not isinstance(message, (bytes, str)):
        return {name.lstrip('_'): fields(getattr(message, name)) for name in names
                if 'check_fields' not in name}
    if isinstance(message, bytes):
        return list(message)
    if hasattr(message, '__len__') and not isinstance(message, str):
        return [fields(item) for item in message]
    return message


def places(content, opcode):
    """Return first byte and end of the records of a kind."""
    return [(len(MAGIC) + start - HEAD.size, len(MAGIC) + end)
            for kind, start, end in parts(content[len(MAGIC):-len(MAGIC)]) if kind == opcode]
