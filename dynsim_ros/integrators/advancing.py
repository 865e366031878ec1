# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
A state that goes on by a step as its rates are written, so that these need no memory of their own.

What is written to Advancing[i] is a rate; times the step, it is added to number i of the state.
"""

import operator
from typing import NamedTuple

from numba import types
from numba.extending import overload

from ..physics.cells import CellsType
from ..physics.fused import fused


class Advancing(NamedTuple):
    """step [s]: number or Lanes; state: Cells. Each of its numbers is to be written once."""

    step: float
    state: CellsType

    def __setitem__(self, i, rate):
        """Add the step times a rate."""
        self.state[i] = fused(self.step, rate, self.state[i])


@overload(operator.setitem)
def _set_item(cells, i, rate):
    if isinstance(cells, types.NamedTuple) and cells.instance_class is Advancing:
        def add(cells, i, rate):
            cells.state[i] = fused(cells.step, rate, cells.state[i])
        return add
    return None
