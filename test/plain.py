# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The formulas compiled and as the plain Python that they are written in."""

import json
import os
import sys

import numba
import numpy as np
import pytest
from tree import output_of, ROOT


def compiled(formula):
    """Return a formula as compiled code runs it: called from Python it would run as Python."""
    @numba.njit(error_model='numpy')
    def call(*arguments):
        return formula(*arguments)
    return call


def compiled_and_plain(formula):
    """Return a decorator that runs a test with both forms, as the argument `formula`."""
    return pytest.mark.parametrize('formula', [compiled(formula), formula.py_func],
                                   ids=['compiled', 'plain'])


def vectors(count):
    """Return `count` random vectors as tuples, the same ones in every run."""
    return [tuple(row) for row in np.random.default_rng(count).normal(size=(count, 3)).tolist()]


def environment(**more):
    """Return the environment of a process that runs this tree."""
    paths = [str(ROOT), str(ROOT / 'test'), os.environ.get('PYTHONPATH', '')]
    return dict(os.environ) | {'PYTHONPATH': os.pathsep.join(filter(None, paths))} | more


def in_plain_python(script, *arguments):
    """Run a script with nothing compiled and return what it prints as JSON."""
    return json.loads(output_of([sys.executable, script, *arguments],
                                env=environment(NUMBA_DISABLE_JIT='1')))
