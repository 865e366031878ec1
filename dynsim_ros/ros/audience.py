# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Who listens to which publisher: noted when it changes, not asked for at every tick."""

from rclpy.event_handler import PublisherEventCallbacks, UnsupportedEventTypeError


class Audience:
    """
    Keeps count of the subscribers of publishers.

    changed: called, without arguments, when somebody begins or ceases to listen. version: grows
    with every such change; is_told: whether the middleware tells of changes by itself; where it
    does not, look() has to be called now and then. For one thread, but for `hears`.
    """

    def __init__(self, changed):
        self._changed = changed
        self._heard = {}
        self.version = 0
        self.is_told = True

    def of(self, create):
        """Return the publisher that create(event_callbacks=...) makes, and watch over it."""
        try:
            publisher = create(PublisherEventCallbacks(matched=lambda _: self.look()))
        except UnsupportedEventTypeError:
            self.is_told = False
            publisher = create(None)
        self._heard[publisher] = False
        return publisher

    def hears(self, publisher):
        """Tell whether anybody listens to a publisher."""
        return self._heard[publisher]

    def look(self):
        """Ask how many listen to each publisher."""
        heard = {publisher: publisher.get_subscription_count() > 0 for publisher in self._heard}
        if heard != self._heard:
            self._heard = heard
            self.version += 1
            self._changed()
