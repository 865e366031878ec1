# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated time on /clock."""

from rclpy.qos import QoSProfile

from .message_types import message_class
from ..messages.cdr import Template
from ..messages.channel import stamp

_CLOCK = 'rosgraph_msgs/msg/Clock'


class ClockPublisher:
    """Publishes /clock; the publisher is made when it is first wanted. audience: Audience."""

    def __init__(self, node, audience):
        self._node = node
        self._audience = audience
        self._publisher = None
        self._pack = Template(_CLOCK).pack

    def begin(self):
        """Make the publisher unless there is one."""
        if self._publisher is None:
            self._publisher = self._audience.of(lambda events: self._node.create_publisher(
                message_class(_CLOCK), '/clock', QoSProfile(depth=1), event_callbacks=events))

    @property
    def is_heard(self):
        """Tell whether anybody listens."""
        return self._publisher is not None and self._audience.hears(self._publisher)

    def publish(self, stamp_ns):
        """Publish a time [ns], if anybody listens."""
        if self.is_heard:
            self._publisher.publish(self._pack(*stamp(stamp_ns)))
