# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Numerical stability far and wide: grids over the parameters of a sphere on a spring, all methods.

Usage: python benchmarks/stability.py [--long] [--methods auto,MuJoCo] [--output FOLDER]; writes
stability.md, stability.csv and a plot for each grid. --long adds runs of 10 000 s without losses.
Every run has a process of its own that is ended if it takes too long. README.md beside this file
tells what the outcomes mean.
"""

import argparse
from dataclasses import dataclass, replace
from pathlib import Path
import sys
import time

from forked import CRASH, Forked, TIMEOUT
from measure import use_one_core
from metric import error
import numpy as np
import peers
from quiet import silence_libraries
from stability_cells import case_of, energy, energy_scale, grid, GRIDS, Parameters
import stability_long
from stability_methods import METHODS, PLAIN, reference, run
import stability_tables
from states import initial
import tables

# A run, and the two runs of a reference, may take this long [s].
LIMIT, REFERENCE_LIMIT = 1.5, 6.0
# PyBullet is driven from Python, which is not its fault.
LIMITS = {'pybullet': 5.0}
# The error of a method with a tolerance may be that many tolerances, times what the cell makes of
# a difference at the start, but not above PLAIN; a reference is known to so much, times that.
FACTOR, KNOWN_TO = 10.0, 1e-11


@dataclass(frozen=True)
class Cell:
    """What came of one method in one cell of a grid."""

    grid: tuple
    method: str
    parameters: Parameters
    outcome: str
    error: float | None
    allowed: float | None
    energy_change: float | None
    work: int | None
    seconds: float
    reason: str


def judge(method, parameters, result, truth):
    """Return (outcome, error, allowed error, relative change of energy, reason)."""
    if result in (TIMEOUT, CRASH):
        return result, None, None, None, ''
    if result.refused is not None:
        return 'refused', None, None, None, result.refused
    scene, y = case_of(parameters).scene, result.state
    if not np.isfinite(y).all():
        return 'not finite', None, None, None, ''
    y0 = initial(scene)
    with np.errstate(over='ignore'):
        change = (energy(scene, y) - energy(scene, y0)) / energy_scale(scene, y0)
    if not change <= 1e-3:
        found = None if truth is None else error(scene, y, truth[0])
        return 'energy grew', found, None, change, ''
    if truth is None:
        return 'no reference', None, None, change, ''
    expected, _, growth = truth
    own = method.peer is None and method.value is not None
    allowed = min(PLAIN, FACTOR * method.value * growth) if own else PLAIN
    found = error(scene, y, expected)
    if KNOWN_TO * growth > 0.1 * allowed:
        return 'no reference', found, allowed, change, ''
    if found <= allowed:
        return 'ok', found, allowed, change, ''
    outcome = 'outside tolerance' if result.shortfall is None else 'outside, and says so'
    return outcome, found, allowed, change, result.shortfall or ''


class Memory:
    """Runs what was not run yet: where grids share a cell, it is run once."""

    def __init__(self):
        self._runs, self._references = Forked(run), Forked(reference)
        self._known = {}

    def result(self, method, parameters):
        """Return (Result, TIMEOUT or CRASH; seconds)."""
        if method.value is not None:
            parameters = replace(parameters, step=Parameters.step)
        key = (method, parameters)
        if key not in self._known:
            start = time.perf_counter()
            found = self._runs.ask(key, LIMITS.get(method.peer, LIMIT))
            self._known[key] = found, time.perf_counter() - start
        return self._known[key]

    def truth(self, parameters):
        """Return what reference() does; None where it takes too long."""
        parameters = replace(parameters, step=Parameters.step)
        if parameters not in self._known:
            found = self._references.ask(parameters, REFERENCE_LIMIT)
            self._known[parameters] = None if found in (TIMEOUT, CRASH) else found
        return self._known[parameters]

    def end(self):
        """End the processes."""
        self._runs.end()
        self._references.end()


def run_grids(methods):
    """Return (Cells, {(grid, Parameters): how its reference was had})."""
    memory, cells, references = Memory(), [], {}
    for axes in GRIDS:
        start = time.time()
        for parameters in grid(*axes):
            truth = memory.truth(parameters)
            references[axes, parameters] = 'none' if truth is None else truth[1]
            for method in methods:
                result, seconds = memory.result(method, parameters)
                outcome, found, allowed, change, reason = judge(method, parameters, result, truth)
                cells.append(Cell(axes, method.name, parameters, outcome, found, allowed, change,
                                  getattr(result, 'work', None), seconds, reason))
        print(f'{axes[0]} x {axes[1]}: {time.time() - start:.0f} s', flush=True)
    memory.end()
    return cells, references


def usable(methods):
    """Return (the methods whose peers are there, versions, what is left out)."""
    versions, missing = [], {}
    for name in dict.fromkeys(method.peer for method in methods if method.peer):
        try:
            versions.append(f'{name} {peers.peer(name).available()}')
        except peers.Unavailable as reason:
            missing[name] = f'{name}: {reason}'
            print(f'left out: {missing[name]}', flush=True)
    return ([method for method in methods if method.peer not in missing], versions,
            list(missing.values()))


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('--long', action='store_true', help='add runs of 10 000 s without losses')
    parser.add_argument('--methods', type=lambda text: tuple(text.split(',')), default=('',),
                        help='beginnings of names of methods, with commas (default: all)')
    parser.add_argument('--output', type=Path, default=Path(__file__).parent,
                        help='folder for the results (default: that of this file)')
    options = parser.parse_args()
    options.chosen = [method for method in METHODS if method.name.startswith(options.methods)]
    if not options.chosen:
        parser.error('--methods: none begins so; there are '
                     + ', '.join(method.name for method in METHODS))
    return options


def main():
    options = arguments()
    silence_libraries()
    use_one_core()
    methods, versions, missing = usable(options.chosen)
    # Compiled here once, the kernels are there in the forked processes.
    for kind in (Parameters(stiffness=1e7, damping=0.0), Parameters(stiffness=1e7)):
        for method in methods:
            run((method, kind))
        reference(kind)
    start = time.time()
    cells, references = run_grids(methods)
    print(f'{len(cells)} cells in {time.time() - start:.0f} s', flush=True)
    lines = stability_long.markdown(stability_long.drifts()) if options.long else []
    text = stability_tables.markdown(
        cells, references, [*tables.base_versions(), *versions], missing, lines)
    stability_tables.write_csv(options.output / 'stability.csv', cells, references)
    (options.output / 'stability.md').write_text(text, encoding='utf-8')
    stability_tables.plots(cells, options.output)
    print(text)


if __name__ == '__main__':
    sys.exit(main())
