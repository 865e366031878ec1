# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The air that resists motion, and its own motion (wind and whirl)."""

from dataclasses import dataclass

from .quantity import check_quantities, quantity

_ZERO = (0.0, 0.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class Air:
    """
    Air resistance, linear in the velocity relative to the air.

    linear_drag: b_air,1 and rotational_drag: b_air,2, None where there is no such resistance;
    velocity: (3,) of the air in world [m/s]; angular_velocity: (3,) of the air in world [rad/s].
    """

    linear_drag: float | None = quantity('N s/m', 'resistance to translation b_air,1',
                                         minimum=0.0, maximum=1e6, default=None)
    rotational_drag: float | None = quantity('N m s/rad', 'resistance to rotation b_air,2',
                                             minimum=0.0, maximum=1e6, default=None)
    velocity: tuple = quantity('m/s', 'velocity of the air (wind) in world', kind='vector',
                               minimum=-1e4, maximum=1e4, default=_ZERO)
    angular_velocity: tuple = quantity('rad/s', 'angular velocity of the air (whirl) in world',
                                       kind='vector', minimum=-1e4, maximum=1e4, default=_ZERO)

    def __post_init__(self):
        check_quantities(self, 'air.')
