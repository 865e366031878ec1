# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The same run gives the same bits: again, in another process, after a reset, not compiled."""

import ast
import json
import math
import re
import sys

from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import MoveAnchor, PushBody, SetValues, Simulator
from hash_of_runs import bits_of, bits_of_all, called_by_kernels
from plain import environment, in_plain_python
import pytest
from tree import output_of, ROOT

SCRIPT = ROOT / 'test' / 'hash_of_runs.py'
# A C library that takes the processor for one without FMA and AVX2.
PLAINER = {'GLIBC_TUNABLES': 'glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2'}
# What a kernel may call: what IEEE 754 fixes to the last bit, work on integers and memory, what
# has to do with being called from Python, and hints to the compiler, of which no code is made.
HARMLESS = re.compile(r'(llvm\.)?(sqrt|fma|floor|fabs|copysign|is\.fpclass)\b'
                      r'|llvm\.(?!pow).*\.(v\d+)?i\d+$|llvm\.(mem|masked|stack|lifetime|assume)'
                      r'|Py|numba_|NRT_')
# What of a module of mathematics is fixed to the last bit, or made of integers.
FIXED = {'comb', 'copysign', 'factorial', 'floor', 'inf', 'isfinite', 'nan', 'pi', 'sqrt'}


@pytest.fixture(scope='module')
def here():
    return bits_of_all()


def test_two_runs(here):
    assert bits_of_all() == here


def elsewhere(*words, **variables):
    """Return what SCRIPT prints in a process with other environment variables."""
    return json.loads(output_of([sys.executable, SCRIPT, *words], env=environment(**variables)))


def test_two_processes(here):
    assert elsewhere(**PLAINER) == here


def test_two_processes_with_rotations_by_axis_and_angle():
    name, method = 'sphere_on_spring', 'explicit_euler_axis_angle'
    assert elsewhere(method, name, **PLAINER) == {f'{name} {method}': bits_of(name, method)}


def test_kernels_call_no_function_of_the_c_library(here):
    """Nor what the compiler makes such a call of."""
    called = called_by_kernels()
    assert 'llvm.sqrt.f64' in called
    assert {name for name in called if not HARMLESS.match(name)} == set()


def test_compiled_and_as_plain_python(here):
    assert in_plain_python(SCRIPT) == here


def test_on_a_processor_that_fuses_nothing(here):
    """Nor has it vectors of four numbers; what is written as fused is so on any."""
    found = elsewhere('auto', 'particle_on_spring', NUMBA_CPU_NAME='generic',
                      NUMBA_CPU_FEATURES='')
    assert found.items() <= here.items()
    assert len(found) == 1


@pytest.mark.parametrize('room', ['scene', 'physics', 'integrators', 'simulation'])
def test_nothing_that_adds_up_differently_elsewhere(room):
    """
    Let no number go through what differs with the Python or the machine.

    The sum() of Python 3.12 compensates, that of 3.11 does not; numpy's linear algebra and dot
    products are those of whatever BLAS it was built with; math.hypot has changed, too.
    """
    for path in (ROOT / 'dynsim_ros' / room).rglob('*.py'):
        for call in ast.walk(ast.parse(path.read_text())):
            name = ast.unparse(call.func) if isinstance(call, ast.Call) else ''
            counts = name == 'sum' and 'isinstance' in ast.unparse(call)
            assert counts or (name not in ('sum', 'math.hypot', 'math.fsum', 'math.dist', 'np.dot')
                              and not name.startswith('np.linalg')), f'{path}:{call.lineno}'


@pytest.mark.parametrize('room', ['physics', 'integrators', 'simulation/rows'])
def test_nothing_of_the_c_library_in_what_is_compiled(room):
    for path in (ROOT / 'dynsim_ros' / room).rglob('*.py'):
        for node in ast.walk(ast.parse(path.read_text())):
            name = ast.unparse(node) if isinstance(node, ast.Attribute) else ''
            module, _, function = name.partition('.')
            if module in ('math', 'np') and hasattr(math, function.replace('arc', 'a')):
                assert function in FIXED, f'{path}:{node.lineno}: {name}'


def bits(run):
    return [snapshot.state.tobytes() + snapshot.anchors.tobytes() for snapshot in run.snapshots]


@pytest.mark.parametrize('method', ['rk4', 'auto'])
def test_reset_restores_every_bit(method):
    simulator = Simulator(load_scene('sphere_on_spring'), integrator=method,
                          anchor_interpolation='linear')
    first = bits(simulator.run(0.3))
    for command in (MoveAnchor('hand', (0.1, 0, 2)), PushBody('sphere', (0, 0, 9)),
                    SetValues({'spring.stiffness': 200, 'sphere.mass': 2, 'rate': 50,
                               'hand.velocity': (1, 0, 0), 'gravity': 1, 'step': 0.002,
                               'anchor_interpolation': 'hold', 'wrench_timeout': 9})):
        simulator.apply(command)
        simulator.run(0.05)
    simulator.reset()
    assert (simulator.epoch, simulator.time_ns, simulator.tick) == (1, 0, 0)
    assert simulator.scene == load_scene('sphere_on_spring')
    assert simulator.settings == simulator.initial_settings
    assert bits(simulator.run(0.3)) == first
