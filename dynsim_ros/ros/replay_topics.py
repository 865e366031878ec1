# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Publishers for the topics of a bag, where the recorded message types are installed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from rclpy.exceptions import InvalidTopicNameException
from rclpy.node import Node
from rclpy.publisher import Publisher

from .message_types import message_class
from .qos import profile
from ..bag.reader import Channel
from ..messages.definitions import definition, MessageDefinitionError
from ..messages.qos import STATE

# Length of a publisher's queue: in a burst none may push out what is not delivered yet.
BURST = 1000


class ReplayError(ValueError):
    """A bag that cannot be played as asked; one line of text."""


def publishers_for(node: Node, channels: Iterable[Channel], remap: Mapping[str, str],
                   warnings: list[str]) -> dict[str, Publisher]:
    """
    Return a publisher for each channel that can be played, by recorded topic.

    What cannot be played is named in one line that is appended to `warnings`. Raises
    ReplayError where nothing is left.
    """
    publishers, left_out = {}, []
    for channel in channels:
        try:
            publishers[channel.topic] = _publisher(
                node, channel, remap.get(channel.topic, channel.topic))
        except ReplayError as error:
            left_out.append(f'{channel.topic} ({error})')
    if not publishers:
        raise ReplayError('no topic can be played'
                          + (': ' + ', '.join(left_out) if left_out else ''))
    if left_out:
        warnings.append('left out: ' + ', '.join(left_out))
    return publishers


def _publisher(node: Node, channel: Channel, topic: str) -> Publisher:
    """Return a publisher that offers what was offered; raises ReplayError for what cannot be."""
    if channel.encoding != 'cdr':
        raise ReplayError(f"its messages are '{channel.encoding}', not CDR")
    message_class = _message_class(channel)
    qos = channel.qos or STATE
    if qos.durability == 'volatile':
        qos = replace(qos, depth=max(qos.depth, BURST))
    try:
        return node.create_publisher(message_class, topic, profile(qos))
    except InvalidTopicNameException:
        raise ReplayError(f"'{topic}' is no ROS topic name") from None


def _message_class(channel: Channel) -> type:
    """Return the Python class of a channel's type; raises ReplayError where there is none."""
    try:
        found = message_class(channel.type_name)
    except (ImportError, AttributeError, ValueError):
        raise ReplayError(f"type '{channel.type_name}' is not installed") from None
    try:
        installed = definition(channel.type_name).type_hash
    except MessageDefinitionError:
        installed = ''
    if installed and channel.type_hash.startswith('RIHS01_') and channel.type_hash != installed:
        raise ReplayError(f"type '{channel.type_name}' was recorded with another definition")
    return found
