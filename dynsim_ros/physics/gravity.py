# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Gravity (sheet, 1.3)."""

from .jit import formula
from .vector import scale


@formula
def gravity_force(mass, gravity, down):
    """Return m g down: (3,) [N]; mass [kg], gravity [m/s^2], down: (3,) unit vector in world."""
    return scale(mass * gravity, down)
