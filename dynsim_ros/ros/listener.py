# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Messages taken when they are wanted, without a callback for each."""

from __future__ import annotations

from collections.abc import Mapping

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy

from .message_types import message_class

# What is not taken in time makes room for what is newer; nobody is asked to send anything again.
_QOS = QoSProfile(depth=100, reliability=ReliabilityPolicy.BEST_EFFORT)


class Listener:
    """
    Subscribes to topics; what arrives waits, as bytes, until it is taken.

    node: one that no executor serves: a callback for each message would cost many times as much.
    """

    def __init__(self, node: Node):
        self._node = node
        self._subscriptions = {}

    def listen(self, topics: Mapping[str, str]):
        """Listen to {full name of a topic: type name}, and to nothing else from here on."""
        for topic in [*self._subscriptions]:
            if topic not in topics:
                self._node.destroy_subscription(self._subscriptions.pop(topic))
        for topic, type_name in topics.items():
            if topic not in self._subscriptions:
                self._subscriptions[topic] = self._node.create_subscription(
                    message_class(type_name), topic, lambda _: None, _QOS, raw=True)

    def take(self, topic: str) -> list[bytes]:
        """Return what arrived on a topic since the last call, oldest first, at most 100."""
        subscription = self._subscriptions.get(topic)
        taken: list[bytes] = []
        if subscription is None:
            return taken
        with subscription.handle:
            while len(taken) < _QOS.depth:
                found = subscription.handle.take_message(subscription.msg_type, True)
                if found is None:
                    break
                taken.append(found[0])
        return taken
