# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
What the benchmarks compare, one module each, all with the same functions.

available(): the version as text; raises Unavailable with the reason where it cannot be used.
supports(case): None, or why the peer cannot have the case.
settings(case): list of Setting, those of one method in order from coarse to fine.
prepare(case, setting): a Run, all set up: compiled, allocated, warm.
prepare_samples(case, setting, times): the same, for states at given times (where it exists).
"""

from collections.abc import Callable
from dataclasses import dataclass
import importlib
import importlib.metadata
import math
import time

import numpy as np

# In the order of the tables.
NAMES = ('ours', 'heyoka', 'heyoka_reduced', 'numbalsoda', 'scipy', 'mujoco', 'drake', 'pybullet')
# It is given equations that dynsim_ros found: shown, but not counted as an engine to be beaten.
NOT_COUNTED = ('heyoka_reduced',)
# Where its code and data happen to lie in memory makes one integrator up to twice as fast as the
# next one like it: of so many, the fastest is taken.
INSTANCES = 4


class Unavailable(Exception):
    """Why a peer cannot be measured."""


@dataclass(frozen=True)
class Setting:
    """A method of a peer with its tolerance or step [s]."""

    method: str
    value: float

    def __str__(self):
        return f'{self.method} {self.value:.3g}'


@dataclass(frozen=True)
class Run:
    """
    A run that is ready to be timed.

    run(): what is timed, returns whatever comes out; state(result): that as a state, laid out as
    in states.py, not timed; None where the run failed.
    """

    run: Callable
    state: Callable


def peer(name):
    """Return the module of a peer."""
    return importlib.import_module(f'peers.{name}')


def tolerances(coarsest, finest):
    """Return powers of ten in steps of 10^(1/4); both are exponents, the first one the larger."""
    return [10.0 ** (quarter / 4) for quarter in range(4 * coarsest, 4 * finest - 1, -1)]


def steps(duration, longest, shortest):
    """
    Return steps [s] in steps of about 10^(1/4), coarse first.

    Each is a whole number of nanoseconds and goes into the duration without rest.
    """
    whole = round(duration * 1e9)
    divisors = np.array([2 ** i * 5 ** j for i in range(40) for j in range(20)
                         if whole % (2 ** i * 5 ** j) == 0])
    wanted = longest * 10.0 ** (-0.25 * np.arange(4 * math.log10(longest / shortest) + 0.5))
    counts = [min(divisors, key=lambda d: abs(math.log(d * step / duration))) for step in wanted]
    return [duration / int(count) for count in dict.fromkeys(counts)]


def installed(module, distribution=None):
    """Return (module, its version); raises Unavailable."""
    try:
        found = importlib.import_module(module)
        return found, importlib.metadata.version(distribution or module)
    except Exception as error:  # a broken installation of a peer raises anything
        raise Unavailable(f'{module} cannot be imported: {error}') from None


def fastest(runs):
    """Return the run that takes the least time."""
    return min(runs, key=least_time)


def least_time(run):
    times = []
    while len(times) < 5 and sum(times) < 0.05:
        start = time.perf_counter()
        run()
        times.append(time.perf_counter() - start)
    return min(times)
