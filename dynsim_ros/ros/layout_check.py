# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Whether ROS serialises messages as our rows lay them out; typed messages where it does not."""

import struct

from rclpy.serialization import serialize_message

from .message_types import message_class
from ..messages.cdr import decode, encode
from ..messages.definitions import definition


def layout_fault(channels):
    """
    Return, in one line, which row of some Channels ROS serialises differently; None for none.

    Every row is filled with numbers all of whose bytes differ. Padding may hold anything, in
    rclpy's bytes as in ours.
    """
    for channel in channels:
        if channel.row is not None and (fault := _fault(channel.row.template)):
            return f'{channel.topic}: {fault}: typed messages are published instead'
    return None


def typed_message(type_name, value):
    """
    Return rclpy's message for a nested dict, as messages.cdr.decode returns it.

    `publisher.publish(typed_message(type_name, decode(type_name, data)))` sends what `data` hold
    in whatever layout ROS has.
    """
    message = message_class(type_name)()
    for field in definition(type_name).fields:
        given = value[field.name]
        if field.is_message:
            is_array = field.is_sequence or field.length is not None
            given = ([typed_message(field.type_name, part) for part in given] if is_array
                     else typed_message(field.type_name, given))
        setattr(message, field.name, given)
    return message


def _fault(template):
    """Return what is wrong with a Template's layout, in a few words, None if nothing is."""
    ours, nested = bytearray(template.content), decode(template.type_name, template.content)
    for number, (leaf, place) in enumerate(template.places.items()):
        value = _distinct(number, place.code)
        if place.start + struct.calcsize(place.code) > len(ours):
            return f'{leaf} is beyond the {template.size} bytes of {template.type_name}'
        struct.pack_into('<' + place.code, ours, place.start, value)
        _set(nested, leaf.split('.'), value)
    theirs = serialize_message(typed_message(template.type_name, nested))
    # rclpy sends more than there is in some cases, for which it has guessed the size.
    if len(theirs) < len(ours) or len(encode(template.type_name, nested)) != len(ours):
        return f'{template.type_name} has {len(ours)} bytes here and {len(theirs)} in ROS'
    differs = [i for i in range(len(ours)) if ours[i] != theirs[i] and i not in template.padding]
    if differs:
        return f'ROS lays {template.type_name} out differently from byte {differs[0]} on'
    return None


def _distinct(number, code):
    """Return a value for leaf `number`, the bytes of which are all different."""
    first = 1 + 7 * number
    data = bytes((first + 11 * i) % 97 + 1 for i in range(struct.calcsize(code)))
    return struct.unpack('<' + code, data)[0]


def _set(nested, path, value):
    """Put a value where a dotted name points to, in dicts and lists."""
    *way, last = path
    for part in way:
        nested = nested[int(part)] if isinstance(nested, list) else nested[part]
    nested[int(last) if isinstance(nested, list) else last] = value
