# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Whole numbers that kernels are compiled for: they are part of the type, and nothing is looked up.

Loops over them are written out, and Cells that are addressed by them are kept in registers. In
plain Python they are numbers and tuples of numbers.
"""

import operator

from llvmlite import ir
from numba import types
from numba.core.imputils import lower_cast, lower_constant
from numba.core.typeconv import Conversion
from numba.core.typing.builtins import infer_global
from numba.core.typing.templates import AbstractTemplate, signature
from numba.extending import (lower_builtin, models, NativeValue, register_model, typeof_impl,
                             unbox)

from .jit import overload


class Known(int):
    """A number that kernels are compiled for."""


class KnownIndex(tuple):
    """Numbers that kernels are compiled for, in place of an array of them."""


class KnownType(types.Type):
    """The type of a Known: another one for each number. It goes where an int64 is asked for."""

    def __init__(self, number):
        self.number = number
        super().__init__(name=f'Known({number})')

    def can_convert_to(self, typing_context, other):
        """Let it stand for an int64."""
        return Conversion.safe if other == types.int64 else None


class KnownIndexType(types.Type):
    """The type of a KnownIndex."""

    def __init__(self, numbers):
        self.numbers = numbers
        super().__init__(name=f'KnownIndex{numbers}')


@typeof_impl.register(Known)
def _type_of_known(value, context):
    return KnownType(int(value))


@typeof_impl.register(KnownIndex)
def _type_of_index(value, context):
    return KnownIndexType(tuple(map(int, value)))


@register_model(KnownType)
@register_model(KnownIndexType)
class _Nothing(models.OpaqueModel):
    """All is in the type."""


@unbox(KnownType)
@unbox(KnownIndexType)
def _unbox(numba_type, value, c):
    return NativeValue(c.context.get_dummy_value())


@lower_constant(KnownType)
def _constant(context, builder, numba_type, value):
    return context.get_dummy_value()


def _whole(number):
    return ir.Constant(ir.IntType(64), number)


@lower_cast(KnownType, types.Integer)
def _cast(context, builder, from_type, to_type, value):
    return _whole(from_type.number)


@infer_global(operator.getitem)
class _GetNumber(AbstractTemplate):
    def generic(self, args, kws):
        if isinstance(args[0], KnownIndexType) and isinstance(args[1], types.Integer):
            return signature(types.int64, args[0], types.intp)
        return None


@lower_builtin(operator.getitem, KnownIndexType, types.intp)
def _lower_get(context, builder, sig, args):
    *others, value = enumerate(sig.args[0].numbers)
    value = _whole(value[1])
    for i, number in others:
        value = builder.select(builder.icmp_signed('==', args[1], _whole(i)), _whole(number),
                               value)
    return value


@overload(len)
def _length(index):
    if isinstance(index, KnownIndexType):
        length = len(index.numbers)
        return lambda index: length
    return None
