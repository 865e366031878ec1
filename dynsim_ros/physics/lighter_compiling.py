# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What numba does while it compiles and nobody needs: a sixth of the time that kernels take."""

from contextlib import contextmanager, nullcontext
import copy
import gc

from numba.core import event, ir
from numba.core.compiler_lock import global_compiler_lock

# What a scope consists of, as far as it is known here: one that has other parts is left alone.
_PARTS = {'parent', 'localvars', 'loc', 'redefined', 'var_redefinitions'}
# New objects until Python looks for cycles among them: compiling makes millions that are needed.
_OBJECTS = 20_000


def _copy_of_scope(scope, memo):
    """
    Copy an ir.Scope with its own lists of variables, but not every variable in them.

    To write a part into a function, numba copies each of its blocks, and with each block all
    variables of the whole part: a tenth of the time, for copies that it throws away.
    """
    new = memo[id(scope)] = copy.copy(scope)
    new.localvars = copy.copy(scope.localvars)
    new.localvars._con = scope.localvars._con.copy()
    new.redefined = scope.redefined.copy()
    new.var_redefinitions = scope.var_redefinitions.copy()
    for name, versions in scope.var_redefinitions.items():
        new.var_redefinitions[name] = versions.copy()
    return new


def _no_timer(kind, callback):
    """
    Measure nothing, in place of numba's event.install_timer.

    It measures how long LLVM and numba's lock are held for each function, and where one is
    compiled for another, for that one, too: each call of LLVM, a quarter of a million for a large
    scene, is told to some seven timers.
    """
    return nullcontext()


def _is_known(scope):
    return vars(scope).keys() == _PARTS and vars(scope.localvars).keys() == {'_con'}


@contextmanager
def lighter_compiling():
    """Let numba compile with less work meanwhile: the same code comes out."""
    with global_compiler_lock:
        thresholds, install_timer = gc.get_threshold(), event.install_timer
        replaces = (_is_known(ir.Scope(None, ir.Loc(__file__, 1)))
                    and '__deepcopy__' not in vars(ir.Scope))
        if 0 < thresholds[0] < _OBJECTS:
            gc.set_threshold(_OBJECTS, *thresholds[1:])
        if replaces:
            ir.Scope.__deepcopy__ = _copy_of_scope
        event.install_timer = _no_timer
        try:
            yield
        finally:
            event.install_timer = install_timer
            gc.set_threshold(*thresholds)
            if replaces:
                del ir.Scope.__deepcopy__
