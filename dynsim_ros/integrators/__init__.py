# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The integration methods, one file each, chosen by name."""

from collections.abc import Callable
from dataclasses import dataclass

from . import explicit_euler, explicit_euler_axis_angle, rk4, semi_implicit_euler
from ..scene import did_you_mean, SceneError


@dataclass(frozen=True)
class Method:
    """
    An integration method.

    order: of convergence;
    advance(model, anchors, pushes, t_ns, h_ns, steps, y, scratch): takes steps of length h_ns,
    beginning at time t_ns, both integers [ns], so that the times of the steps do not depend on
    how many of them are taken at once. model: Model; anchors: (n, 6) position [m] and velocity
    [m/s] in world at time 0; pushes: forces [N] and torques [N m] laid out as the state; y:
    state, replaced; scratch: (SCRATCH_ROWS, state_size), overwritten. Returns the sum over the
    steps of what normalising the quaternions removed.
    """

    name: str
    order: int
    advance: Callable
    description: str


METHODS = {method.name: method for method in (
    Method('rk4', 4, rk4.advance, 'classical Runge-Kutta'),
    Method('semi_implicit_euler', 1, semi_implicit_euler.advance,
           'velocities first, bounded energy error'),
    Method('explicit_euler', 1, explicit_euler.advance,
           'as on the formula sheet, quaternion updated by H'),
    Method('explicit_euler_axis_angle', 1, explicit_euler_axis_angle.advance,
           'as on the formula sheet, orientation updated by axis and angle'),
)}
DEFAULT_METHOD = 'rk4'
# Rows of scratch memory that a method may use, each as long as the state.
SCRATCH_ROWS = 5


def method_named(name):
    """Return the Method; raise SceneError with the nearest known name."""
    if not isinstance(name, str) or name not in METHODS:
        raise SceneError(f"integrator: '{name}' is not known; " + did_you_mean(name, METHODS))
    return METHODS[name]
