# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
A state that goes on by a step as its rates are written, so that these need no memory of their own.

What is written to Advancing[i] is a rate; times the step, it is added to number i of a change, and
this to the start. The step is divided by masses and inertias, not forces and moments: that does
not have to wait until they are there.
"""

import operator
from typing import NamedTuple

from numba import types

from .cells import CellsType
from .equations_of_motion import linear_acceleration, scalar_angular_acceleration
from .fused import fused
from .jit import formula, overload
from .vector import put


class Advancing(NamedTuple):
    """
    step [s]: number or Lanes; change: Cells, a state less `start`; whole: Cells, then the state.

    Each of its numbers is to be written once.
    """

    step: float
    change: CellsType
    start: CellsType
    whole: CellsType

    def __setitem__(self, i, rate):
        """Add the step times a rate."""
        advance(self, i, self.step, rate)


@formula
def advance(cells, i, step, rate):
    """Add step times rate to number i of Advancing."""
    change = fused(step, rate, cells.change[i])
    cells.change[i] = change
    cells.whole[i] = cells.start[i] + change


@formula
def advance_three(cells, i, step, rates):
    """Add step times rates (3,) to three numbers of Advancing."""
    advance(cells, i, step, rates[0])
    advance(cells, i + 1, step, rates[1])
    advance(cells, i + 2, step, rates[2])


def _advances(cells):
    """Tell whether a type is that of Advancing."""
    return isinstance(cells, types.NamedTuple) and cells.instance_class is Advancing


@overload(operator.setitem)
def _set_item(cells, i, rate):
    if not _advances(cells):
        return None

    def add(cells, i, rate):
        advance(cells, i, cells.step, rate)
    return add


def put_linear_acceleration(out, i, force, inverse_mass):
    """Write the acceleration by a force (3,) to Cells, an array or Advancing."""
    if isinstance(out, Advancing):
        advance_three(out, i, out.step * inverse_mass, force)
    else:
        put(out, i, linear_acceleration(force, inverse_mass))


def put_angular_acceleration(out, i, moment, inverse_inertia):
    """Write likewise the angular acceleration by a moment (3,), where inertia is a number."""
    if isinstance(out, Advancing):
        advance_three(out, i, out.step * inverse_inertia, moment)
    else:
        put(out, i, scalar_angular_acceleration(moment, inverse_inertia))


@overload(put_linear_acceleration)
def _put_linear_acceleration(out, i, force, inverse_mass):
    if _advances(out):
        return lambda out, i, force, inverse_mass: advance_three(
            out, i, out.step * inverse_mass, force)
    return lambda out, i, force, inverse_mass: put(
        out, i, linear_acceleration(force, inverse_mass))


@overload(put_angular_acceleration)
def _put_angular_acceleration(out, i, moment, inverse_inertia):
    if _advances(out):
        return lambda out, i, moment, inverse_inertia: advance_three(
            out, i, out.step * inverse_inertia, moment)
    return lambda out, i, moment, inverse_inertia: put(
        out, i, scalar_angular_acceleration(moment, inverse_inertia))
