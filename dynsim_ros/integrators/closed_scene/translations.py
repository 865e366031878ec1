# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which motions of centres of mass have a closed form, and their constants."""

from fractions import Fraction
import math

import numpy as np

from .motion import Centred, Flights, Holding, Line
from ..closed_form import centre_of_springs, is_along, least_length, spring_line
from ...physics.rotation import rotate
from ...physics.vector import add, cross, dot, subtract

_ZERO = (0.0, 0.0, 0.0)
# How much of its natural length, or of its length at the beginning, a spring must keep for ever.
# Far more than rounding, and long before anything but L tells how close the ends are.
_LEAST_LENGTH = 1e-3
# Far more than rounding: what is farther from a line need not be looked at exactly.
_NEARLY = 1e-9


def forces(model, drive):
    """Return the constant force on each centre of mass [N]: (bodies, 3)."""
    bodies = len(model.mass)
    total = np.zeros((bodies, 3)) if model.weight is None else model.weight.copy()
    if drive.pushes is not None:
        total += drive.pushes[3 * bodies:6 * bodies].reshape(bodies, 3)
    return total


def drag_and_wind(model):
    """Return the linear drag [N s/m] and the wind (3,) [m/s], (None, None) without drag."""
    if model.air is None or model.air.linear_drag is None:
        return None, None
    return model.air.linear_drag, model.air.velocity or (0.0, 0.0, 0.0)


def flights(model, drive):
    """Return the Flights of bodies on which no spring acts."""
    acceleration = forces(model, drive) / model.mass[:, np.newaxis]
    return Flights(model.mass, acceleration, *drag_and_wind(model))


def _is_nearly_along(direction, vector, slack):
    """Return whether a vector may have no part across a direction known up to `slack` [m]."""
    return max(map(abs, cross(direction, vector))) <= slack * max(map(abs, vector))


class SingleBody:
    """The only body of a model, what acts on it, and the springs that hold it to anchors."""

    def __init__(self, model, drive, holds):
        self.model, self.holds = model, holds
        self.mass = float(model.mass[0])
        self.force = tuple(forces(model, drive)[0].tolist())
        self.acceleration = tuple(component / self.mass for component in self.force)
        self.drag, self.wind = drag_and_wind(model)
        self.rotating = []
        if model.rigid and drive.pushes is not None:
            self.rotating.append(tuple(drive.pushes[10:13].tolist()))
        if model.air is not None and model.air.angular_velocity is not None:
            self.rotating.append(tuple(model.air.angular_velocity))

    def centred(self):
        """Return ({'centred'}, Holding) on springs of natural length zero, or None."""
        if any(hold.natural_length or hold.damping or any(hold.end.offset)
               for hold in self.holds):
            return None
        stiffnesses = [hold.stiffness for hold in self.holds]
        positions = [hold.anchor.position for hold in self.holds]
        velocities = [hold.anchor.velocity for hold in self.holds]
        stiffness, centre = centre_of_springs(stiffnesses, positions)
        _, velocity = centre_of_springs(stiffnesses, velocities)
        linear = quadratic = 0.0
        for k, c, v in zip(stiffnesses, positions, velocities):
            linear += k * dot(v, subtract(c, centre))
            quadratic += 0.5 * k * dot(v, subtract(v, velocity))
        return ({'centred': Centred(self.mass, stiffness, centre, velocity, self.acceleration,
                                    self.drag, self.wind)},
                self._holding(velocity, linear, quadratic, 0.0))

    def line(self, start):
        """Return ({'line'}, Holding) on the line of the only spring, or None."""
        if len(self.holds) > 1:
            return None
        hold, = self.holds
        anchor = hold.anchor
        position, velocity = (tuple(start[i:i + 3].tolist()) for i in (0, 3))
        arm = _ZERO
        if any(hold.end.offset):
            arm = rotate(tuple(start[6:10].tolist()), hold.end.offset)
        tip = add(position, arm)
        along = [self.acceleration, subtract(velocity, anchor.velocity), arm]
        if self.drag:
            along.append(subtract(self.wind, anchor.velocity))
        if any(arm):
            rotating = [tuple(start[10:13].tolist()), *self.rotating]
            if self.model.general_body is not None and any(map(any, rotating)):
                return None
            along += rotating
        slack = _NEARLY * max(map(abs, (*position, *arm, *anchor.position)))
        if not all(_is_nearly_along(subtract(tip, anchor.position), vector, slack)
                   for vector in along):
            return None
        # Without rounding, also that of the difference: across the line all may be unstable.
        direction = tuple(Fraction(x) + Fraction(a) - Fraction(p)
                          for x, a, p in zip(position, arm, anchor.position))
        if tip == anchor.position or not all(
                is_along(direction, tuple(map(Fraction, vector))) for vector in along):
            return None
        spring = spring_line(tip, velocity, anchor.position, anchor.velocity, self.mass,
                             hold.stiffness, hold.natural_length, hold.damping,
                             self.acceleration, self.drag, self.wind)
        least = _LEAST_LENGTH * max(spring.natural_length, spring.length)
        if not least_length(spring, math.inf) > least:
            return None
        return {'line': Line(spring, arm)}, self._holding(anchor.velocity, 0.0, 0.0, hold.damping)

    def _holding(self, velocity, linear, quadratic, damping):
        return Holding(self.mass, self.force, velocity, linear, quadratic, damping,
                       self.drag or 0.0, self.wind or _ZERO)
