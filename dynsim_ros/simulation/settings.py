# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How a run is computed, beside what is simulated: ticks, method, step, treatment of commands."""

from dataclasses import dataclass, fields
from functools import cached_property

from ..integrators import DEFAULT_METHOD, method_named, METHODS
from ..scene import did_you_mean, Quantity, SceneError
from ..scene.quantity import check_quantities, quantities_of, quantity

SECOND = 1_000_000_000
INTERPOLATIONS = ('hold', 'linear')


@dataclass(frozen=True, kw_only=True)
class Settings:
    """
    The settings of a run; all may change at a tick boundary.

    rate: ticks per second of simulated time [Hz]; integrator: name of a method; step: its fixed
    step [s], independent of the ticks; tolerance: of error-controlled methods: the error estimate
    of every step stays below it, in each body's position [m], velocity [m/s], orientation
    (quaternion) and angular velocity [rad/s], each over max(1, its size); anchor_interpolation:
    'hold' (a commanded anchor jumps) or 'linear' (it moves there at constant velocity);
    wrench_timeout: how long a commanded wrench acts unless replaced [s], 0 for ever.
    """

    rate: float = quantity('Hz', 'ticks per second of simulated time', minimum=0.1, maximum=1e4,
                           default=100.0)
    integrator: str = DEFAULT_METHOD
    step: float = quantity('s', 'step of methods of fixed step', minimum=1e-7, maximum=1.0,
                           default=1e-3)
    tolerance: float = quantity('', 'error that a step of an error-controlled method may have',
                                minimum=1e-14, maximum=0.1, default=1e-9)
    anchor_interpolation: str = 'hold'
    wrench_timeout: float = quantity('s', 'how long a commanded wrench acts unless replaced, '
                                     '0 = until replaced', minimum=0.0, maximum=1e6, default=0.5)

    def __post_init__(self):
        check_quantities(self, '')
        method_named(self.integrator)
        if self.anchor_interpolation not in INTERPOLATIONS:
            raise SceneError(f"anchor_interpolation: '{self.anchor_interpolation}' is not known; "
                             + did_you_mean(self.anchor_interpolation, INTERPOLATIONS))

    @cached_property
    def tick_ns(self):
        """Return the length of a tick: an integer [ns]."""
        return round(SECOND / self.rate)

    @property
    def step_ns(self):
        """Return the length of a step of the integrator: an integer [ns]."""
        return round(self.step * SECOND)


SETTING_NAMES = tuple(field.name for field in fields(Settings))
CHOICES = {'integrator': tuple(METHODS), 'anchor_interpolation': INTERPOLATIONS}


def setting_quantities():
    """Return {name: Quantity} of the numeric settings."""
    return quantities_of(Settings())


def setting_description(name):
    """Return what a setting is, in words, as for a parameter descriptor."""
    if name in CHOICES:
        meaning = {'integrator': 'integration method',
                   'anchor_interpolation': 'how a commanded anchor gets to its new position'}
        return f'{meaning[name]}: one of ' + ', '.join(CHOICES[name])
    known: Quantity = setting_quantities()[name]
    return known.description + (f' [{known.unit}]' if known.unit else '')
