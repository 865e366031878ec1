# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Four numbers side by side.

Lanes: four float64 on which +, -, *, / and root() act at once, in one instruction where the
processor has vectors of four (AVX2; fewer lanes at a time elsewhere, with the same results to
the last bit). A formula that is written for numbers serves for Lanes, too. In plain Python a
Lanes is a numpy array of four.
"""

import math
import operator

from llvmlite import ir
from numba import types
from numba.core.imputils import lower_cast
from numba.core.typeconv import Conversion
from numba.core.typing.builtins import infer_global
from numba.core.typing.templates import ConcreteTemplate, signature
from numba.extending import intrinsic, lower_builtin, models, register_model
import numpy as np

from .jit import overload

COUNT = 4

VECTOR = ir.VectorType(ir.DoubleType(), COUNT)
FLOAT = types.float64
# Memory of the package is aligned to numbers, not to vectors [bytes].
ALIGNMENT = 8


class LanesType(types.Type):
    """The type of Lanes."""

    def __init__(self):
        super().__init__(name='Lanes')

    def can_convert_from(self, typing_context, other):
        """Let a number stand where Lanes are asked for: it is then the same in all of them."""
        return Conversion.safe if isinstance(other, types.Float) else None

    def unify(self, typing_context, other):
        """Return the type of what is Lanes on one way through the code, a number on another."""
        return self if isinstance(other, types.Float) else None


@register_model(LanesType)
class LanesModel(models.PrimitiveModel):
    """Lanes are a vector of the processor."""

    def __init__(self, manager, numba_type):
        super().__init__(manager, numba_type, VECTOR)


LANES = LanesType()


def _spread(builder, number):
    """Return a vector with one number in all lanes."""
    vector = builder.insert_element(ir.Constant(VECTOR, ir.Undefined), number,
                                    ir.Constant(ir.IntType(32), 0))
    first = ir.Constant(ir.VectorType(ir.IntType(32), COUNT), [0] * COUNT)
    return builder.shuffle_vector(vector, ir.Constant(VECTOR, ir.Undefined), first)


def as_vector(builder, value, numba_type):
    """Return a value of the type float64 or LANES as the compiler's vector."""
    return value if numba_type == LANES else _spread(builder, value)


def _define_operator(function, instruction):
    pairs = ((LANES, LANES), (LANES, FLOAT), (FLOAT, LANES))

    class Template(ConcreteTemplate):
        cases = [signature(LANES, *pair) for pair in pairs]

    def lower(context, builder, sig, args):
        a, b = (as_vector(builder, *pair) for pair in zip(args, sig.args))
        return getattr(builder, instruction)(a, b)

    infer_global(function)(Template)
    for pair in pairs:
        lower_builtin(function, *pair)(lower)


for _function, _instruction in ((operator.add, 'fadd'), (operator.sub, 'fsub'),
                                (operator.mul, 'fmul'), (operator.truediv, 'fdiv')):
    _define_operator(_function, _instruction)


@infer_global(operator.neg)
class _Negative(ConcreteTemplate):
    cases = [signature(LANES, LANES)]


@lower_builtin(operator.neg, LANES)
def _lower_negative(context, builder, sig, args):
    return builder.fneg(args[0])


@lower_cast(types.Float, LanesType)
def _cast(context, builder, from_type, to_type, value):
    return _spread(builder, value)


def root(x):
    """Return the square root of a number or of Lanes."""
    return np.sqrt(x) if isinstance(x, np.ndarray) else math.sqrt(x)


@intrinsic
def _vector_root(typing_context, x):
    def generate(context, builder, sig, args):
        name = f'llvm.sqrt.v{COUNT}f64'
        function = builder.module.declare_intrinsic(
            name, fnty=ir.FunctionType(VECTOR, [VECTOR]))
        return builder.call(function, args)
    return LANES(LANES), generate


@overload(root)
def _root(x):
    if x == LANES:
        return lambda x: _vector_root(x)
    return lambda x: math.sqrt(x)


def choose(mask, a, b):
    """Return Lanes: a where mask is not zero, else b; mask: Lanes; a, b: numbers or Lanes."""
    return np.where(mask != 0.0, a, b)


@intrinsic
def _vector_choose(typing_context, mask, a, b):
    def generate(context, builder, sig, args):
        a, b = (as_vector(builder, *pair) for pair in zip(args[1:], sig.args[1:]))
        zero = ir.Constant(VECTOR, [0.0] * COUNT)
        return builder.select(builder.fcmp_unordered('!=', args[0], zero), a, b)
    return LANES(LANES, a, b), generate


@overload(choose)
def _choose(mask, a, b):
    return lambda mask, a, b: _vector_choose(mask, a, b)


def total(lanes):
    """Return the sum of the four numbers, added in pairs."""
    return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3])


@intrinsic
def _vector_total(typing_context, lanes):
    def generate(context, builder, sig, args):
        numbers = [builder.extract_element(args[0], ir.Constant(ir.IntType(32), i))
                   for i in range(COUNT)]
        return builder.fadd(builder.fadd(numbers[0], numbers[1]),
                            builder.fadd(numbers[2], numbers[3]))
    return FLOAT(LANES), generate


@overload(total)
def _total(lanes):
    return lambda lanes: _vector_total(lanes)


def totals(a, b, c, d):
    """Return Lanes of the total of each of four Lanes."""
    return np.array([total(lanes) for lanes in (a, b, c, d)])


@intrinsic
def _vector_totals(typing_context, a, b, c, d):
    def generate(context, builder, sig, args):
        def shuffled(first, second, *numbers):
            return builder.shuffle_vector(first, second, ir.Constant(
                ir.VectorType(ir.IntType(32), COUNT), numbers))

        def pairs(first, second):
            # Sums of numbers 0 and 1, then of 2 and 3, of both in turns.
            return builder.fadd(shuffled(first, second, 0, 4, 2, 6),
                                shuffled(first, second, 1, 5, 3, 7))
        low, high = pairs(*args[:2]), pairs(*args[2:])
        return builder.fadd(shuffled(low, high, 0, 1, 4, 5), shuffled(low, high, 2, 3, 6, 7))
    return LANES(LANES, LANES, LANES, LANES), generate


@overload(totals)
def _totals(a, b, c, d):
    return lambda a, b, c, d: _vector_totals(a, b, c, d)


def lane(lanes, i):
    """Return number i of the four; a number alone stands for all of them."""
    return lanes[i] if isinstance(lanes, np.ndarray) else lanes


@intrinsic
def _vector_lane(typing_context, lanes, i):
    def generate(context, builder, sig, args):
        return builder.extract_element(args[0], builder.trunc(args[1], ir.IntType(32)))
    return FLOAT(LANES, types.intp), generate


@overload(lane)
def _lane(lanes, i):
    return lambda lanes, i: _vector_lane(lanes, i)


def spread(x):
    """Return Lanes with one number in all of them."""
    return np.full(COUNT, x)


@intrinsic
def _vector_spread(typing_context, x):
    return LANES(FLOAT), lambda context, builder, sig, args: _spread(builder, args[0])


@overload(spread)
def _spread_number(x):
    return lambda x: _vector_spread(x)


def lanes_at(array, i):
    """Return the Lanes that stand in array[i] to array[i + 3]; array: (n,) float64."""
    return np.array(array[i:i + COUNT])


@intrinsic
def _vector_load(typing_context, array, i):
    def generate(context, builder, sig, args):
        data = context.make_array(sig.args[0])(context, builder, args[0]).data
        place = builder.bitcast(builder.gep(data, [args[1]]), ir.PointerType(VECTOR))
        value = builder.load(place)
        value.align = ALIGNMENT
        return value
    return LANES(array, types.intp), generate


@overload(lanes_at)
def _lanes_at(array, i):
    return lambda array, i: _vector_load(array, i)


def put_lanes(array, i, lanes):
    """Write Lanes to array[i] to array[i + 3]; array: (n,) float64."""
    array[i:i + COUNT] = lanes


@intrinsic
def _vector_store(typing_context, array, i, lanes):
    def generate(context, builder, sig, args):
        data = context.make_array(sig.args[0])(context, builder, args[0]).data
        place = builder.bitcast(builder.gep(data, [args[1]]), ir.PointerType(VECTOR))
        builder.store(args[2], place).align = ALIGNMENT
        return context.get_dummy_value()
    return types.none(array, types.intp, LANES), generate


@overload(put_lanes)
def _put_lanes(array, i, lanes):
    return lambda array, i, lanes: _vector_store(array, i, lanes)
