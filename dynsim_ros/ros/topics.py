# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The node's publishers: what nobody listens to and nobody records is not built."""

from rclpy.qos_overriding_options import QoSOverridingOptions

from .audience import Audience
from .layout_check import layout_fault
from .message_types import has_message_class, message_class
from .publish_rates import every_of
from .qos import profile
from .schedule import Schedule
from .sending import Sending
from ..messages.tick_rows import TickRows
from ..messages.transforms import TRANSFORMS


class Topics:
    """
    Publishes the messages of a list of Channels, as the bytes that are also recorded.

    Topics are relative to the node (~/) or full names. rows: TickRows of the channels; audience:
    Audience of these and other publishers; options: dict of the node's own parameters, always up
    to date. skipped: messages that were due but not built; built: those that were.
    """

    def __init__(self, node, channels, rows: TickRows, audience: Audience, options):
        self.channels = channels
        self.rows = rows
        self.skipped = self.built = 0
        self._node = node
        self._audience = audience
        self._options = options
        self._sending = Sending(rows, self._is_laid_out())
        self._publishers = [self._publisher(channel) for channel in channels]
        self._schedule = None
        self._rates_version = 0

    def _is_laid_out(self):
        """Tell whether ROS lays messages out as rows do; warn where it does not."""
        fault = layout_fault(self.channels)
        if fault is not None:
            self._node.get_logger().warning(fault)
        return fault is None

    def resolve(self, topic):
        """Return the full name that a topic has here, remapped if it is."""
        return self._node.resolve_topic_name(_below_node(topic))

    def _publisher(self, channel):
        if channel.type_name == TRANSFORMS and not has_message_class(TRANSFORMS):
            # ROS on PyPI has no tf; bags have it all the same.
            return None
        return self._audience.of(lambda events: self._node.create_publisher(
            message_class(channel.type_name), _below_node(channel.topic), profile(channel.qos),
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
            event_callbacks=events))

    def schedule(self, tick_ns, recording):
        """Return the Schedule for ticks of a length [ns]."""
        made_for = self._audience.version, self._rates_version, tick_ns, recording
        schedule = self._schedule
        if schedule is None or schedule.made_for != made_for:
            heard = [publisher is not None and self._audience.hears(publisher)
                     for publisher in self._publishers]
            every = [every_of(channel, tick_ns, self._options) for channel in self.channels]
            schedule = self._schedule = Schedule(
                self.channels, self._publishers, every, heard, recording, made_for, self.rows,
                self._sending)
        return schedule

    def rates_changed(self):
        """Take note that an option may have changed."""
        self._rates_version += 1

    def pass_over(self, first, last, tick_ns):
        """Count what was due at the ticks first + 1 to last, at which nobody wanted anything."""
        self.skipped += self.schedule(tick_ns, False).due_between(first, last)

    def publish(self, simulator, stamp_ns, recording):
        """
        Publish what is due at a tick.

        Returns the Wanted rows, which `rows` holds now, and {topic: CDR bytes} of other messages.
        """
        due = self.schedule(simulator.settings.tick_ns, recording).due(simulator.tick)
        if due.rows.numbers:
            self.rows.fill(simulator.instant(), stamp_ns, due.rows)
            due.send()
        self._count(simulator.tick, 1, len(due.rows.numbers) + len(due.others))
        return due.rows, self._publish_others(due.others, simulator, stamp_ns)

    def were_published(self, stretch, done, simulator, stamp_ns):
        """
        Take note that the rows of the first so many ticks of a Stretch were published.

        Publishes what else is due at the last tick of all, which a Simulator stands at then;
        returns {topic: CDR bytes} of that.
        """
        others = stretch.others if done == stretch.count else []
        self._count(simulator.tick, done, done * len(stretch.due.rows.numbers) + len(others))
        return self._publish_others(others, simulator, stamp_ns)

    def _publish_others(self, others, simulator, stamp_ns):
        """Publish what is no row; return {topic: CDR bytes}."""
        messages, snapshot = {}, simulator.snapshot() if others else None
        for channel, publisher in others:
            messages[channel.topic] = data = channel.encode(snapshot, stamp_ns)
            if publisher is not None:
                publisher.publish(data)
        return messages

    def _count(self, last, ticks, built):
        """Count so many messages that were built of so many ticks up to the last one."""
        self.built += built
        self.skipped += self._schedule.due_between(last - ticks, last) - built


def _below_node(topic):
    return topic if topic[0] == '/' else f'~/{topic}'
