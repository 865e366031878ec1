# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is compiled with less work is the same code, and numba and Python are as before."""

from copy import deepcopy
import gc
import re

from dynsim_ros.physics.jit import part
from dynsim_ros.physics.lighter_compiling import lighter_compiling
import numba
from numba.core import event, ir
import numpy as np
import pytest


@part
def grown(x, times):
    y = x
    for k in range(times):
        if y > 3.0:
            y = np.sqrt(y) + k
        for _ in range(k):
            y = 1.1 * y + x
    return y


@part
def grown_twice(x, times):
    y = grown(x, times)
    return grown(y, times + 1) if y > x else y


def newly_compiled():
    """Return a function as numba has compiled it just now, with parts written into it."""
    @numba.njit((numba.float64[:], numba.int64))
    def all_grown(x, times):
        total = 0.0
        for i in range(x.shape[0]):
            total += grown_twice(x[i], times)
        return total
    return all_grown


def code(compiled):
    """Return the code in the form of LLVM, with names that numba makes anew each time numbered."""
    (text,) = compiled.inspect_llvm().values()
    text, numbers = re.sub(r' *;.*', '', text), {}
    return re.sub(r'[%@]?"?[\w.$]*\d[\w.$]*"?', lambda name: str(
        numbers.setdefault(name.group().strip('%@"'), len(numbers))), text)


def metadata(compiled):
    """Return what numba has written down about a function of one signature."""
    return compiled.get_metadata(*compiled.signatures)


def test_the_same_code_comes_out():
    before = newly_compiled()
    with lighter_compiling():
        lighter = newly_compiled()
    assert code(lighter) == code(before)
    assert 'timers' in metadata(before) and 'timers' not in metadata(lighter)
    assert lighter(np.arange(5.0), 4) == before(np.arange(5.0), 4)


def test_all_is_as_before_afterwards():
    scope = ir.Scope(None, ir.Loc('here', 1))
    scope.define('x', scope.loc)
    thresholds, install_timer = gc.get_threshold(), event.install_timer
    with pytest.raises(KeyError), lighter_compiling():
        assert gc.get_threshold() != thresholds and event.install_timer is not install_timer
        assert deepcopy(scope).get('x') is scope.get('x')
        raise KeyError
    assert gc.get_threshold() == thresholds and event.install_timer is install_timer
    assert deepcopy(scope).get('x') is not scope.get('x')


def test_a_collector_that_is_switched_off_stays_so():
    thresholds = gc.get_threshold()
    gc.set_threshold(0)
    try:
        with lighter_compiling():
            assert gc.get_threshold()[0] == 0
    finally:
        gc.set_threshold(*thresholds)
