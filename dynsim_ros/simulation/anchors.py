# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The motion of the anchors: at rest, uniform, or on the way to where a command sends them."""

import numpy as np

from .settings import SECOND
from ..physics.drive import initial_anchors

# A command without a recent predecessor takes as long as this to carry out ('linear') [ns].
LONGEST_MOVE = SECOND // 10


class Anchors:
    """
    Positions and velocities of all anchors, exact between the instants at which they change.

    motion: (n, 6) position [m] and velocity [m/s] in world at the instant `since` [ns].
    """

    def __init__(self, scene):
        self.motion = initial_anchors(scene)
        self.since = 0
        self._targets = {}
        self._commanded = {}
        # Whether all are known to be.
        self._are_at_rest = False

    def go_on(self, since, motion):
        """Let `since` and `motion` be these."""
        self.since, self._are_at_rest = since, False
        self.motion[:] = motion

    def motion_at(self, time_ns):
        """Return (n, 6) position and velocity at an instant before the next change."""
        motion = self.motion.copy()
        if time_ns != self.since:
            motion[:, :3] += motion[:, 3:] * ((time_ns - self.since) * 1e-9)
        return motion

    def under_way(self, i):
        """
        Return what is known of the future and the past of anchor i.

        (arrival [ns], its target (3,) [m]) or None, and when it was commanded last [ns] or None.
        """
        return self._targets.get(i), self._commanded.get(i)

    def put_under_way(self, i, target, commanded):
        """Let what under_way returns be so."""
        for where, value in ((self._targets, target), (self._commanded, commanded)):
            where.pop(i, None)
            if value is not None:
                where[i] = value

    def rebase(self, time_ns):
        """Let `since` be an instant before the next change."""
        if not self._are_at_rest:
            self._are_at_rest = not self.motion[:, 3:].any()
        # Most anchors are at rest, which is seen sooner than added up.
        if time_ns != self.since and not self._are_at_rest:
            # In place: the kernels hold on to this array.
            self.motion[:] = self.motion_at(time_ns)
        self.since = time_ns

    def next_change(self):
        """Return the instant at which the next moving anchor arrives [ns], or None."""
        if not self._targets:
            return None
        return min(arrival for arrival, _ in self._targets.values())

    def arrive(self):
        """Stop, exactly at its target, every anchor that has arrived by `since`."""
        for i in [i for i, (arrival, _) in self._targets.items() if arrival <= self.since]:
            self.place(i, self._targets[i][1])

    def place(self, i, position):
        """Put anchor i at a position, at rest."""
        self.motion[i] = (*position, 0.0, 0.0, 0.0)
        self._targets.pop(i, None)

    def set_velocity(self, i, velocity):
        """Let anchor i go on from where it is at a velocity: (3,) [m/s]."""
        self._set_off(i, velocity)
        self._targets.pop(i, None)

    def command(self, i, position, linear, tick_ns):
        """
        Send anchor i to a position: at once, or ('linear') at constant velocity.

        The move then takes as long as passed since the command before it, so that an anchor
        that is commanded regularly moves evenly, one interval behind; at least one tick, at most
        LONGEST_MOVE.
        """
        interval = self.since - self._commanded.get(i, self.since - LONGEST_MOVE)
        self._commanded[i] = self.since
        if not linear:
            self.place(i, position)
            return
        duration = max(min(interval, LONGEST_MOVE), tick_ns)
        self._set_off(i, (np.array(position) - self.motion[i, :3]) / (duration * 1e-9))
        self._targets[i] = (self.since + duration, position)

    def _set_off(self, i, velocity):
        self.motion[i, 3:] = velocity
        self._are_at_rest = False
