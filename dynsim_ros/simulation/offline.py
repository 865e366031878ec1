# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A run whose commands are known beforehand; no clock, no ROS."""

from .changes import changed
from .settings import SECOND, Settings
from .simulator import Simulator


def simulator_with(scene, values):
    """
    Return a Simulator of a scene, with some quantities and settings other than they are there.

    values: {name: value}, initial conditions included. Raises SceneError.
    """
    return Simulator(*changed(scene, Settings(), values, at_start=True))


class OfflineRun:
    """
    Runs a simulator through timed commands.

    commands: [(time_ns, command)] in order of time; sink: has tick(simulator), called at every
    tick, and command(time_ns, command), called for every command that took effect. It may have
    advance(simulator, most) as well: to advance by some ticks, one at least, and note each.
    What remains in commands after a run is later than its end.
    """

    def __init__(self, simulator, commands, sink):
        self._simulator = simulator
        self.commands = list(commands)
        self._sink = sink
        self._advance = getattr(sink, 'advance', self._tick)

    def run(self, duration, is_stopped=lambda: False):
        """
        Run for a duration [s], or until is_stopped() says so.

        Raises DivergenceError, or SceneError for a wrong command.
        """
        simulator = self._simulator
        end = simulator.time_ns + round(duration * SECOND)
        self._sink.tick(simulator)
        while simulator.time_ns < end and not is_stopped():
            self._command()
            until = min(end, self.commands[0][0]) if self.commands else end
            self._advance(simulator, -((simulator.time_ns - until) // simulator.settings.tick_ns))

    def _tick(self, simulator, _most):
        simulator.advance_tick()
        self._sink.tick(simulator)

    def _command(self):
        """Carry out the commands whose time has come."""
        simulator = self._simulator
        while self.commands and self.commands[0][0] <= simulator.time_ns:
            command = simulator.apply(self.commands.pop(0)[1])
            self._sink.command(simulator.time_ns, command)
