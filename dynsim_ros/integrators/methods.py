# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The list of the methods."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

from . import (dop853_tableau, explicit_euler, explicit_euler_axis_angle, leapfrog,
               linearly_implicit_euler, radau_tableau, rk4, semi_implicit_euler)
from .adaptive import Tableaux
from .dense_output import explicit_table, radau_table, stiff_table
from .gragg import gragg_schedule
from .stiff import stiff_schedule
from .stiffness import EXPLICIT_REACH
from .stormer import stormer_schedule
from ..scene import did_you_mean, SceneError


class Adaptive(NamedTuple):
    """
    What an adaptive method computes with.

    power: of the step in its error estimate; share: of the tolerance, for an estimate that is
    nearer to the error than those of the others are, or farther from it; reach: steps of an
    explicit method that are longer than this over the fastest rate may be held back by stability;
    keeps_reaches: whether it keeps the reaches of a few springs, see reaches.
    """

    tableaux: Tableaux
    power: float
    share: float = 1.0
    reach: float = EXPLICIT_REACH
    keeps_reaches: bool = False


@dataclass(frozen=True)
class Method:
    """
    An integration method.

    order: of convergence; None: it depends on the scene;
    advance(model, drive, t_ns, h_ns, steps, state, memory): of a method of fixed step: takes
    steps of length h_ns, beginning at time t_ns, both integers [ns], so that the times of the
    steps do not depend on how many of them are taken at once. model: Model; drive: Drive; state:
    replaced; memory: new_memory(), overwritten. Returns the sum over the steps of what
    normalising the quaternions removed. None: the method chooses its own steps.
    """

    name: str
    order: int | None
    description: str
    advance: Callable | None = None


METHODS = {method.name: method for method in (
    Method('auto', None, 'closed forms, extrapolation or stiff, whatever the motion asks for'),
    Method('extrapolation', 14, 'error-controlled; extrapolated midpoint rule, order 10, 14 or 12 '
           'by the tolerance (rule of Störmer, 10 or 12, for particles without losses)'),
    Method('stiff', 7,
           'error-controlled; extrapolated linearly implicit Euler, for stiff springs'),
    Method('radau', 15, 'error-controlled; Radau IIA with 8 stages, for stiff springs, exact'),
    Method('dop853', 8, 'error-controlled; Runge-Kutta of Dormand and Prince'),
    Method('rk4', 4, 'classical Runge-Kutta', rk4.advance),
    Method('leapfrog', 2, 'reversible, bounded energy error', leapfrog.advance),
    Method('semi_implicit_euler', 1, 'velocities first, bounded energy error',
           semi_implicit_euler.advance),
    Method('linearly_implicit_euler', 1, 'stable for springs and dampers of any strength',
           linearly_implicit_euler.advance),
    Method('explicit_euler', 1, 'as on the formula sheet, quaternion updated by H',
           explicit_euler.advance),
    Method('explicit_euler_axis_angle', 1,
           'as on the formula sheet, orientation updated by axis and angle',
           explicit_euler_axis_angle.advance),
)}
DEFAULT_METHOD = 'auto'


def method_named(name):
    """Return the Method; raise SceneError with the nearest known name."""
    if not isinstance(name, str) or name not in METHODS:
        raise SceneError(f"integrator: '{name}' is not known; " + did_you_mean(name, METHODS))
    return METHODS[name]


@lru_cache
def gragg_extrapolation(sequences):
    """Return the Adaptive of Gragg's rule with some Sequences."""
    return _extrapolation('gragg', gragg_schedule, sequences)


@lru_cache
def stormer_extrapolation(sequences):
    """Return the Adaptive of Störmer's rule with some Sequences."""
    return _extrapolation('stormer', stormer_schedule, sequences)


def _extrapolation(rule, schedule, sequences):
    plan = schedule(sequences.substeps, sequences.stages)
    tableaux = Tableaux(None, None, None, None, None, explicit_table(sequences.dense_substeps))
    return Adaptive(tableaux._replace(**{rule: plan}), 2.0 * plan.stages - 1.0, sequences.share,
                    sequences.reach, sequences.keeps_reaches)


@lru_cache
def stiff():
    """Return the Adaptive of the linearly implicit method."""
    plan = stiff_schedule()
    return Adaptive(Tableaux(None, None, plan, None, None, stiff_table()), float(plan.stages))


@lru_cache
def dop853():
    """Return the Adaptive of the method of Dormand and Prince."""
    return Adaptive(Tableaux(None, None, None, dop853_tableau.table(), None,
                             explicit_table()), 8.0)


@lru_cache
def radau():
    """Return the Adaptive of the collocation method."""
    return Adaptive(Tableaux(None, None, None, None, radau_tableau.table(), radau_table()), 8.0)
