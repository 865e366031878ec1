# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The same bits from every method that chooses its own steps: again, elsewhere, plain, however seen.

Who looks at a run, how often, and whether works are counted, changes nothing of the motion.
"""

import hashlib
import sys

from by_hand import nothing_compiled
from dynsim_ros.simulation import Propagator, Simulator
import numpy as np
from plain import environment
import pytest
from references import load
from simulated import samples
from tree import output_of

# Extrapolation is compared in test_same_bits.py, a step of dop853 in test_dop853.py.
COMPILED = [('S3q', 'stiff'), ('S3q', 'radau')]
# Prints a digest of what test_compiled_again_and_as_plain_python computes.
DIGEST = """
import hashlib, sys
from references import load
from simulated import samples
found, _ = samples(load(sys.argv[1])[0], 0.2, 100.0, integrator=sys.argv[2], tolerance=1e-6)
print(hashlib.sha256(found.tobytes()).hexdigest())
"""
METHODS = ('extrapolation', 'dop853', 'stiff', 'radau', 'auto', 'leapfrog')


@pytest.mark.parametrize('name, method', COMPILED)
def test_compiled_again_and_as_plain_python(name, method):
    scene = load(name)[0]
    settings = {'integrator': method, 'tolerance': 1e-6}
    compiled, counts = samples(scene, 0.2, 100.0, **settings)
    assert counts['steps'] > 3
    again, _ = samples(scene, 0.2, 100.0, **settings)
    np.testing.assert_array_equal(again, compiled)
    # in a process whose C library takes the processor for one without FMA and AVX2
    plainer = environment(GLIBC_TUNABLES='glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2')
    other = output_of([sys.executable, '-c', DIGEST, name, method], env=plainer)
    assert other.strip() == hashlib.sha256(compiled.tobytes()).hexdigest()
    with nothing_compiled():
        plain, plain_counts = samples(scene, 0.2, 100.0, **settings)
    np.testing.assert_array_equal(plain, compiled)
    assert plain_counts == counts


@pytest.fixture
def plain():
    with nothing_compiled():
        yield


def states(scene, method, rate, instants):
    """Return the states at some instants [ns] of a run in ticks."""
    simulator, found = Simulator(scene, integrator=method, tolerance=1e-6, rate=rate), {}
    while simulator.time_ns < max(instants):
        simulator.advance_tick()
        if simulator.time_ns in instants:
            found[simulator.time_ns] = simulator.snapshot().state
    return np.array([found[instant] for instant in instants])


@pytest.mark.parametrize('method', METHODS)
def test_who_looks_how_often(plain, method):
    scene = load('moving_anchor')[0]
    instants = [40_000_000 * i for i in range(1, 4)]
    often = states(scene, method, 200, instants)
    np.testing.assert_array_equal(states(scene, method, 25, instants), often)
    np.testing.assert_array_equal(states(scene, method, 50, instants), often)
    at_once = Simulator(scene, integrator=method, tolerance=1e-6)
    at_once.advance(instants[-1])
    np.testing.assert_array_equal(at_once.snapshot().state, often[-1])


@pytest.mark.parametrize('method', METHODS)
def test_works_counted_or_not(plain, method):
    scene = load('moving_anchor')[0]
    with_works = states(scene, method, 25, [40_000_000 * i for i in range(1, 4)])
    without = Propagator(scene, integrator=method, tolerance=1e-6).samples(0.12, 25.0)
    assert np.abs(with_works[:, -4:]).max() > 0
    np.testing.assert_array_equal(with_works[:, :-4], without[1:, :-4])


def test_a_propagator_begins_anew_every_time(plain):
    propagator = Propagator(load('S2')[0], tolerance=1e-6)
    first = propagator.samples(0.3, 50.0)
    end = propagator.end_state(0.3)
    np.testing.assert_array_equal(propagator.samples(0.3, 50.0), first)
    np.testing.assert_array_equal(propagator.end_state(0.3), end)
    np.testing.assert_allclose(end, first[-1], atol=1e-6)
