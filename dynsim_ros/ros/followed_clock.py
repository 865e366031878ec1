# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""/clock of another publisher, which a run follows."""

from rclpy.clock import JumpThreshold
from rclpy.duration import Duration

from .pacing import LONGEST_STRIDE

_ANY = JumpThreshold(min_forward=Duration(nanoseconds=1), min_backward=Duration(nanoseconds=-1),
                     on_clock_change=False)


class FollowedClock:
    """
    Lets a run begin when /clock does, follow it, and begin anew when that is set back.

    clock: the node's; moved: called whenever /clock comes; was_set_back: called after the reset.
    """

    def __init__(self, clock, run, pacer, moved, was_set_back):
        self._clock, self._run, self._pacer = clock, run, pacer
        self._was_set_back = was_set_back
        self._seen = 0
        run.waiting = True
        pacer.now, pacer.longest_lag, pacer.is_steady = self.now, LONGEST_STRIDE, False
        self._jumps = clock.create_jump_callback(_ANY, post_callback=lambda _: moved())

    def now(self):
        """Return the time of /clock [ns], 0 before it begins."""
        return self._clock.now().nanoseconds

    def is_good(self):
        """Tell whether /clock has begun; if it was set back, begin a new epoch."""
        last, self._seen = self._seen, self.now()
        if self._seen == 0:
            return False
        if last == 0:
            self._begin()
        elif self._seen < last:
            self._run.reset()
            self._was_set_back()
        return True

    def _begin(self):
        """Go on with /clock from where it is now; a run that waited for it begins there."""
        time_ns = self._run.simulator.time_ns
        self._pacer.restart(time_ns)
        if self._run.waiting:
            self._run.begin(self._seen - time_ns)

    def was_reset(self):
        """Let the new epoch begin now."""
        self._seen = self.now()
        self._run.origin_ns = self._seen - self._run.simulator.time_ns
        self._run.waiting = self._seen == 0
