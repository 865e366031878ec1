# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Cells: memory for numbers or Lanes, addressed with [] as an array is.

Where the indices are known when it is compiled, as they are for a single body, the compiler
keeps them in registers.
"""

import operator

from llvmlite import ir
from numba import types
from numba.core.typing.builtins import infer_global
from numba.core.typing.templates import AbstractTemplate, signature
from numba.extending import intrinsic, lower_builtin, models, register_model
import numpy as np

from .jit import overload
from .known import KnownType
from .lanes import ALIGNMENT, COUNT, FLOAT, LANES, VECTOR
from .state import REACH, REACH_SIZE, state_size, WORKS
from .structure import MOST_SPRINGS


class CellsType(types.Type):
    """The type of Cells; dtype: float64 or LANES."""

    def __init__(self, dtype):
        self.dtype = dtype
        super().__init__(name=f'Cells({dtype})')

    @property
    def element(self):
        """Return the type of an element as LLVM has it."""
        return VECTOR if self.dtype == LANES else ir.DoubleType()


@register_model(CellsType)
class CellsModel(models.PrimitiveModel):
    """Cells are the address of the first one."""

    def __init__(self, manager, numba_type):
        super().__init__(manager, numba_type, ir.PointerType(numba_type.element))


@infer_global(operator.getitem)
class _GetCell(AbstractTemplate):
    def generic(self, args, kws):
        if isinstance(args[0], CellsType) and isinstance(args[1], types.Integer):
            return signature(args[0].dtype, args[0], types.intp)
        return None


@lower_builtin(operator.getitem, CellsType, types.intp)
def _lower_get(context, builder, sig, args):
    value = builder.load(builder.gep(args[0], [args[1]]))
    value.align = ALIGNMENT
    return value


@infer_global(operator.setitem)
class _SetCell(AbstractTemplate):
    def generic(self, args, kws):
        if isinstance(args[0], CellsType) and isinstance(args[1], types.Integer):
            return signature(types.none, args[0], types.intp, args[0].dtype)
        return None


@lower_builtin(operator.setitem, CellsType, types.intp, FLOAT)
@lower_builtin(operator.setitem, CellsType, types.intp, LANES)
def _lower_set(context, builder, sig, args):
    builder.store(args[2], builder.gep(args[0], [args[1]])).align = ALIGNMENT
    return context.get_dummy_value()


def _reservation(cells_type):
    """Return an intrinsic that reserves memory in the frame of the function being compiled."""
    @intrinsic
    def reserve(typing_context, count):
        if not isinstance(count, types.IntegerLiteral):
            return None

        def generate(context, builder, sig, args):
            with builder.goto_entry_block():
                return builder.alloca(cells_type.element, count.literal_value)
        return cells_type(count), generate
    return reserve


def _view(cells_type):
    """Return an intrinsic that gives the Cells beginning at array[i]."""
    @intrinsic
    def view(typing_context, array, i):
        def generate(context, builder, sig, args):
            data = context.make_array(sig.args[0])(context, builder, args[0]).data
            return builder.bitcast(builder.gep(data, [args[1]]),
                                   ir.PointerType(cells_type.element))
        return cells_type(array, types.intp), generate
    return view


_reserve_numbers, _reserve_lanes = (_reservation(CellsType(dtype)) for dtype in (FLOAT, LANES))
_view_numbers, _view_lanes = (_view(CellsType(dtype)) for dtype in (FLOAT, LANES))

# The most that a method keeps at one place for a single body, with arm and reach, or a spring.
_SINGLE = REACH + REACH_SIZE
# The most that it keeps beside a state: the reaches of springs.
_BESIDE = REACH_SIZE * MOST_SPRINGS


def number_cells(several, memory, place, size):
    """
    Return Cells for `size` numbers: in registers where the bodies are known, else in memory.

    several: as in Model; place: where in the memory.
    """
    return [0.0] * (size + len(WORKS) + _BESIDE)


def _known_size(several):
    """Return the most that a method keeps at one place, of the type of Model.several."""
    if isinstance(several, types.NoneType):
        return _SINGLE
    if isinstance(several, types.BaseTuple) and isinstance(several[0], KnownType):
        bodies, rigid = several
        return state_size(bodies.number, rigid.number) + _BESIDE
    return None


# Inlined: what they reserve belongs to the function that calls them.

@overload(number_cells, inline='always')
def _number_cells(several, memory, place, size):
    count = _known_size(several)
    if count is not None:
        return lambda several, memory, place, size: _reserve_numbers(count)
    return lambda several, memory, place, size: _view_numbers(memory, place)


def lane_cells(several, memory, place, size):
    """Return Cells for `size` Lanes; arguments as above, each takes up four numbers of memory."""
    return [np.zeros(COUNT) for _ in range(size + len(WORKS) + _BESIDE)]


@overload(lane_cells, inline='always')
def _lane_cells(several, memory, place, size):
    count = _known_size(several)
    if count is not None:
        return lambda several, memory, place, size: _reserve_lanes(count)
    return lambda several, memory, place, size: _view_lanes(memory, place)
