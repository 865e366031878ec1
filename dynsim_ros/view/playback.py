# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which instant of a recorded run is shown: playing, pausing, seeking, repeating."""

from __future__ import annotations


class Playback:
    """
    The time that is shown [s].

    start, end: of the section that is played [s]; speed: seconds of the run per second.
    """

    def __init__(self, start, end):
        self.first, self.last = start, end
        self.start, self.end = start, end
        self.time = start
        self.speed = 1.0
        self.is_playing = True
        self.repeats = True

    def advance(self, seconds):
        """Let so much time pass [s]."""
        if not self.is_playing:
            return
        self.time += self.speed * seconds
        if self.time < self.end:
            return
        if self.repeats and self.end > self.start:
            self.time = self.start + (self.time - self.end) % (self.end - self.start)
        else:
            self.time, self.is_playing = self.end, False

    def toggle(self):
        """Play or pause; at the end, begin again."""
        self.is_playing = not self.is_playing
        if self.is_playing and self.time >= self.end:
            self.time = self.start

    def seek(self, time):
        """Go to a time, or as near to it as the section reaches."""
        self.time = min(max(time, self.start), self.end)

    def choose(self, start, end):
        """Play only from one time to another."""
        self.start, self.end = start, end
        self.seek(self.time)
