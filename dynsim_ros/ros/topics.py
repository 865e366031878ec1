# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The node's publishers: what nobody listens to and nobody records is not built."""

from rclpy.qos_overriding_options import QoSOverridingOptions

from .message_types import message_class
from .qos import profile


class Topics:
    """
    Publishes the messages of a list of Channels, as the bytes that are also recorded.

    Topics are relative to the node (~/). skipped: messages that were due but not built.
    """

    def __init__(self, node, channels):
        self.channels = channels
        self.skipped = 0
        self._node = node
        self._publishers = [(channel, self._publisher(node, channel)) for channel in channels]

    def resolve(self, topic):
        """Return the full name that a topic has here, remapped if it is."""
        return self._node.resolve_topic_name(topic if topic[0] == '/' else f'~/{topic}')

    def _publisher(self, node, channel):
        return node.create_publisher(
            message_class(channel.type_name), f'~/{channel.topic}', profile(channel.qos),
            qos_overriding_options=QoSOverridingOptions.with_default_policies())

    def publish(self, snapshot, stamp_ns, tick_ns, recording):
        """Publish what is due at a tick; return {topic: CDR bytes} of what was built."""
        built = {}
        for channel, publisher in self._publishers:
            if not channel.is_due(snapshot.tick, tick_ns):
                continue
            heard = publisher.get_subscription_count() > 0
            if not heard and not recording:
                self.skipped += 1
                continue
            data = channel.encode(snapshot, stamp_ns)
            built[channel.topic] = data
            if heard:
                publisher.publish(data)
        return built
