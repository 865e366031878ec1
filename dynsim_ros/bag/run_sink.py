# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A run without ROS on its way into a bag."""

from __future__ import annotations

from collections.abc import Callable
import os

import numpy as np

from .run_bag import RunBag
from ..messages.scene_channels import scene_channels
from ..messages.tick_rows import TickRows


class RunSink:
    """
    Records the ticks and commands of an OfflineRun, all topics at every tick.

    simulator: as it begins; origin_ns: added to simulated time in stamps; node: full name of the
    node in whose place it is; tell: called with the simulated time [ns] at every tick; about: as
    RunBag takes it. Raises OSError or ValueError if the file cannot be made.
    """

    def __init__(self, path: str | os.PathLike, simulator, *, origin_ns: int = 0,
                 node: str = '/dynsim', tell: Callable[[int], None] = lambda time_ns: None,
                 **about):
        """Create the bag."""
        channels = scene_channels(simulator.scene, simulator.layout, node)
        self._others = [channel for channel in channels if channel.row is None]
        self._rows = TickRows(channels, simulator.layout)
        self._all = self._rows.of()
        self._origin_ns, self._tell, self._simulator = origin_ns, tell, simulator
        self._bag = RunBag(path, simulator, channels, self._rows, wait=True, node=node,
                           **about)

    @property
    def content(self) -> str:
        """Return in one clause how many messages are in the bag."""
        return self._bag.content

    @property
    def is_failing(self) -> bool:
        """Tell whether the bag cannot be written now."""
        return self._bag.recorder.is_failing

    @property
    def error(self) -> str | None:
        """Return what kept messages from the bag, and what to do, in one line, or None."""
        recorder = self._bag.recorder
        if not recorder.error:
            return None
        remedy = f'; make room and run: recover {self._bag.path}' if recorder.unfinished else ''
        return f'{recorder.error}; the run was ended at {self._simulator.time:g} s{remedy}'

    def tick(self, simulator):
        """Record what is due at a tick."""
        stamp_ns = self._origin_ns + simulator.time_ns
        self._rows.fill(simulator.instant(), stamp_ns, self._all)
        self._bag.put_rows(self._rows, stamp_ns, self._all)
        self._put_others(simulator, stamp_ns)

    def advance(self, simulator, most):
        """Advance by some ticks, at most so many, and record what is due at each."""
        if not self._bag.can_put_many:
            simulator.advance_tick()
            self.tick(simulator)
            return
        tick, tick_ns = simulator.tick, simulator.settings.tick_ns
        every = [channel.every(tick_ns) for channel in self._others]
        first = self._origin_ns + simulator.time_ns + tick_ns
        instants = simulator.pass_ticks(min([most, *(ticks - tick % ticks for ticks in every)]))
        stamps = first + tick_ns * np.arange(len(instants.states))
        self._rows.fill(instants, first, self._all)
        self._bag.put_many_rows(self._rows, stamps, self._all)
        self._put_others(simulator, int(stamps[-1]))

    def _put_others(self, simulator, stamp_ns):
        """Record what is no row and due at a tick."""
        time_ns, tick_ns = simulator.time_ns, simulator.settings.tick_ns
        due = [channel for channel in self._others if channel.is_due(simulator.tick, tick_ns)]
        if due:
            snapshot = simulator.snapshot()
            self._bag.put(stamp_ns, {channel.topic: channel.encode(snapshot, stamp_ns)
                                     for channel in due})
        self._tell(time_ns)

    def command(self, time_ns, command):
        """Record a command that took effect."""
        self._bag.put_command(self._origin_ns + time_ns, command)

    def close(self):
        """Record how the run stands, and finish the bag."""
        self._bag.put_last(self._origin_ns + self._simulator.time_ns, self._simulator)
        self._bag.close()
