# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A run whose commands are known beforehand; no clock, no ROS."""

from .settings import SECOND, SETTING_NAMES, Settings
from .simulator import Simulator
from ..scene import did_you_mean, scene_quantities, SceneError, with_values


def simulator_with(scene, values):
    """
    Return a Simulator of a scene, with some quantities and settings other than they are there.

    values: {name: value}, initial conditions included. Raises SceneError.
    """
    known = [*SETTING_NAMES, *scene_quantities(scene)]
    for name in values:
        if name not in known:
            raise SceneError(f"'{name}' is no quantity of this scene and no setting; "
                             + did_you_mean(name, known))
    settings = {name: value for name, value in values.items() if name in SETTING_NAMES}
    changes = {name: value for name, value in values.items() if name not in SETTING_NAMES}
    return Simulator(with_values(scene, changes), Settings(**settings))


class OfflineRun:
    """
    Runs a simulator through timed commands.

    commands: [(time_ns, command)] in order of time; sink: has snapshot(snapshot, tick_ns), called
    at every tick, and command(time_ns, command), called for every command that took effect.
    """

    def __init__(self, simulator, commands, sink):
        self._simulator = simulator
        self._commands = list(commands)
        self._sink = sink

    def run(self, duration):
        """Run for a duration [s]; raise DivergenceError, or SceneError for a wrong command."""
        simulator, sink = self._simulator, self._sink
        end = simulator.time_ns + round(duration * SECOND)
        sink.snapshot(simulator.snapshot(), simulator.settings.tick_ns)
        while simulator.time_ns < end:
            self._command()
            simulator.advance_tick()
            sink.snapshot(simulator.snapshot(), simulator.settings.tick_ns)

    def _command(self):
        """Carry out the commands whose time has come."""
        simulator = self._simulator
        while self._commands and self._commands[0][0] <= simulator.time_ns:
            command = simulator.apply(self._commands.pop(0)[1])
            self._sink.command(simulator.time_ns, command)
