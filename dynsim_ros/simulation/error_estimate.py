# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
How far the end of a run is from the exact motion: from a second run, computed more exactly.

With an error-controlled method the second run has a hundredth of the tolerance, with a method of
fixed step half the step; the difference of the two, with Richardson's factor for the latter, is
the estimate. Where rounding, not the method, makes the error, both runs share part of it.
"""

from dataclasses import dataclass, replace
import math

import numpy as np

from .offline import OfflineRun
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
        text = f'position {self.position:.1e} m, velocity {self.velocity:.1e} m/s'
        if self.orientation is not None:
            text += (f', orientation {self.orientation:.1e} rad, '
                     f'angular velocity {self.angular_velocity:.1e} rad/s')
        return text


def estimate_error(simulator, commands, duration):
    """
    Return the ErrorEstimate of a run from its start to a duration [s].

    simulator: as it was at the start; commands: as OfflineRun takes them. Runs the motion twice.
    """
    settings = simulator.initial_settings
    method = method_named(settings.integrator)
    factor = 1.0
    if method.advance is None:
        finer = replace(settings, tolerance=max(settings.tolerance * _TIGHTER,
                                                _SMALLEST_TOLERANCE))
    else:
        finer = replace(settings, step=max(settings.step / 2.0, _SMALLEST_STEP))
        factor = 2.0 ** method.order / (2.0 ** method.order - 1.0)
    ends = [_end(simulator.initial_scene, each, commands, duration)
            for each in (settings, finer)]
    return _difference(*ends, factor)


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
