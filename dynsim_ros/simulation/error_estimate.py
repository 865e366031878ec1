# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
How far the end of a run is from the exact motion: from a second run, computed more exactly.

With an error-controlled method the second run has a hundredth of the tolerance, with a method of
fixed step half the step, also where commands set either; the difference of the two, with
Richardson's factor for the latter, is the estimate. Where rounding, not the method, makes the
error, both runs share part of it.
"""

from dataclasses import dataclass, fields, replace
import math

import numpy as np

from .commands import SetValues
from .offline import OfflineRun
from .settings import SECOND
from .simulator import Simulator
from ..integrators import method_named
from ..physics.rotation import quaternion_norm

_TIGHTER = 0.01
_SMALLEST_TOLERANCE, _SMALLEST_STEP = 1e-14, 1e-7


@dataclass(frozen=True)
class ErrorEstimate:
    """
    The largest errors over all bodies at one instant.

    position [m], velocity [m/s]: of the centre of mass; orientation: angle [rad] and
    angular_velocity [rad/s], None where no body rotates.
    """

    position: float
    velocity: float
    orientation: float | None
    angular_velocity: float | None

    def __str__(self):
        if not any(vars(self).values()):
            return 'rounding alone, a run to be more exact ends in the same state'
        text = f'position {self.position:.1e} m, velocity {self.velocity:.1e} m/s'
        if self.orientation is not None:
            text += (f', orientation {self.orientation:.1e} rad, '
                     f'angular velocity {self.angular_velocity:.1e} rad/s')
        return text


def estimate_error(simulator, commands, duration):
    """
    Return the ErrorEstimate of a run from its start to a duration [s].

    simulator: as it was at the start; commands: as OfflineRun takes them. Runs the motion twice.
    Raises ValueError where no run can be more exact.
    """
    settings = simulator.initial_settings
    factor = max(_factor(each) for each in _settings_used(settings, commands, duration))
    finer = [(time_ns, SetValues(command.values | _finer(command.values))
              if isinstance(command, SetValues) else command) for time_ns, command in commands]
    return _difference(
        _end(simulator.initial_scene, settings, commands, duration),
        _end(simulator.initial_scene, replace(settings, **_finer(vars(settings))), finer,
             duration), factor)


def _finer(values):
    """Return the tolerance and the step for a run to be more exact, of those among values."""
    finer = {}
    if 'tolerance' in values:
        finer['tolerance'] = max(values['tolerance'] * _TIGHTER, _SMALLEST_TOLERANCE)
    if 'step' in values:
        finer['step'] = max(values['step'] / 2.0, _SMALLEST_STEP)
    return finer


def _settings_used(settings, commands, duration):
    """Yield the Settings at the start of a run, and after each command that sets some."""
    yield settings
    names = {field.name for field in fields(settings)}
    for time_ns, command in commands:
        if isinstance(command, SetValues) and time_ns < duration * SECOND:
            values = {name: command.values[name] for name in names & command.values.keys()}
            if values:
                settings = replace(settings, **values)
                yield settings


def _factor(settings):
    """
    Return the error over the difference from a run to be more exact.

    Raises ValueError where there is none.
    """
    method = method_named(settings.integrator)
    if method.advance is None:
        if settings.tolerance <= _SMALLEST_TOLERANCE:
            raise ValueError(f'tolerance {settings.tolerance:g} is the smallest one')
        return 1.0
    if settings.step < 2.0 * _SMALLEST_STEP:
        raise ValueError(f'half of the step {settings.step:g} s would be below '
                         f'{_SMALLEST_STEP:g} s, the shortest one')
    return 2.0 ** method.order / (2.0 ** method.order - 1.0)


def _end(scene, settings, commands, duration):
    last = _Last()
    OfflineRun(Simulator(scene, settings), commands, last).run(duration)
    return last.state


class _Last:
    """Takes the ticks of a run and keeps the last state."""

    def tick(self, simulator):
        """Keep a simulator, which goes on."""
        self._simulator = simulator

    @property
    def state(self):
        """Return the last Snapshot."""
        return self._simulator.snapshot()

    def command(self, time_ns, command):
        """Take a command that took effect."""


def _difference(a, b, factor):
    bodies = a.layout.bodies
    rigid = bodies[:a.layout.rigid]

    def largest(part):
        return factor * max(float(np.abs(part(a, body) - part(b, body)).max()) for body in bodies)

    position = largest(type(a).position)
    velocity = largest(type(a).velocity)
    if not rigid:
        return ErrorEstimate(position, velocity, None, None)
    angle = factor * max(_angle(a.orientation(body), b.orientation(body)) for body in rigid)
    bodies = rigid
    return ErrorEstimate(position, velocity, angle, largest(type(a).angular_velocity))


def _angle(p, q):
    """Return the angle between two orientations [rad]."""
    chords = [sign * q - p for sign in (1.0, -1.0)]
    shorter = min(quaternion_norm(tuple(chord)) for chord in chords)
    return 4.0 * math.asin(0.5 * shorter)
