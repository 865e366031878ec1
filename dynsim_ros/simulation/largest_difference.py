# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How far two runs of one scene are from each other at most, in what, and when."""

from dataclasses import dataclass

import numpy as np

from .commands import SetValues


@dataclass(frozen=True)
class Largest:
    """The largest difference in one quantity of a body, or in the energy: body is None then."""

    body: str | None
    quantity: str
    unit: str
    size: float
    time_ns: int

    def __str__(self):
        name = f'{self.body} {self.quantity}' if self.body else self.quantity
        return f'{name:32} {self.size:8.2g} {self.unit:6} at {self.time_ns * 1e-9:.9g} s'


def largest_differences(one, other, commands, end_ns, is_stopped=lambda simulator: False):
    """
    Run two Simulators side by side to an instant; return [Largest].

    commands: [(time_ns, command)] in order, for both; what sets the integrator, its step or
    tolerance is for the first one only.
    """
    commands, found = list(commands), {}
    while True:
        for key, size in _differences(one.snapshot(), other.snapshot()):
            if key not in found or size > found[key][0]:
                found[key] = size, one.time_ns
        if one.time_ns >= end_ns or is_stopped(one):
            return [Largest(*key, *value) for key, value in found.items()]
        while commands and commands[0][0] <= one.time_ns:
            command = commands.pop(0)[1]
            one.apply(command)
            command = without_method(command)
            if command is not None:
                other.apply(command)
        one.advance_tick()
        other.advance_tick()


def without_method(command):
    """Return a command without what it says about the method, None where nothing is left."""
    if not isinstance(command, SetValues):
        return command
    values = {name: value for name, value in command.values.items()
              if name not in ('integrator', 'step', 'tolerance')}
    return SetValues(values) if values else None


def _differences(a, b):
    """Yield ((body, quantity, unit), size) between two Snapshots."""
    for body in a.layout.bodies:
        yield (body, 'position', 'm'), _length(a.position(body) - b.position(body))
        yield (body, 'velocity', 'm/s'), _length(a.velocity(body) - b.velocity(body))
        if (p := a.orientation(body)) is not None:
            q = b.orientation(body)
            # Both signs of a quaternion are one orientation.
            chord = min(_length(p - q), _length(p + q))
            yield (body, 'orientation', 'rad'), 4.0 * float(np.arcsin(min(0.5 * chord, 1.0)))
            yield (body, 'angular velocity', 'rad/s'), _length(
                a.angular_velocity(body) - b.angular_velocity(body))
    yield (None, 'energy', 'J'), abs(a.energy.total - b.energy.total)


def _length(vector):
    return float(np.sqrt(np.square(vector).sum()))
