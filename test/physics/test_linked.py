# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Formulas are linked into what is compiled, and are no machine code of their own."""

from dynsim_ros.physics.jit import formula, overload
import numba
from numba.core import types


def cube(x):
    return x ** 3


def cube_and_more(x):
    return x ** 3 + 0.5


def negative(x):
    return x < 0


@overload(negative)
def _negative(x):
    return (lambda x: x < 0.0) if isinstance(x, types.Float) else (lambda x: x < 0)


def kernel_with(used):
    @numba.njit(_nrt=False)
    def use(x):
        return -used(x) if negative(x) else used(x)
    return use


def library(compiled):
    (overloaded,) = compiled.overloads.values()
    return overloaded.library


def test_no_machine_code_is_made():
    cubed = formula(cube)
    assert kernel_with(cubed)(-3.0) == 27.0
    assert not list(library(cubed).get_defined_functions())
    assert 'define' not in library(cubed).get_llvm_str()


def test_they_are_in_what_uses_them():
    kernel = kernel_with(formula(cube))
    assert kernel(2.0) == 8.0
    functions = [function.name for function in library(kernel).get_defined_functions()]
    assert functions and not any('cube' in name or 'negative' in name for name in functions)


def test_they_are_loaded_from_the_cache():
    kernel_with(formula(cube_and_more))(2.0)
    again = formula(cube_and_more)
    assert kernel_with(again)(2.0) == 8.5
    assert sum(again.stats.cache_hits.values()) == 1
    assert not sum(again.stats.cache_misses.values())
