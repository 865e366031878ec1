# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Timing: every setting of every peer in interleaved rounds, in one process on one core."""

from dataclasses import dataclass
import gc
import itertools
import math
import os
import time

from levels import cheapest, LEVELS, of_peer
from metric import error
from peers import Setting

# A run that takes longer than this is timed once [s].
ONCE = 0.5
# When a run took longer than this, the finer settings of its method are left out [s].
LONGEST = 5.0
# How long all repetitions of one setting may take together [s].
MOST_FOR_ONE = 3.0
# In a round, a run is repeated at once for this long, but none that takes longer [s]: a first run
# after others is slowed down by what they have left in the caches.
BURST = 2e-3


@dataclass
class Cell:
    """One setting of one peer: its error and its least time so far [s]."""

    peer: str
    setting: Setting
    run: object = None
    error: float = math.inf
    seconds: float = math.inf
    spent: float = 0.0

    def time(self):
        """Run once, and keep the time if it is the least."""
        start = time.perf_counter()
        result = self.run.run()
        seconds = time.perf_counter() - start
        self.seconds = min(self.seconds, seconds)
        self.spent += seconds
        return result


def use_one_core():
    """Stay on the last core that is allowed: the first one has more to do elsewhere."""
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


def measure(jobs, rounds, judge, report, longest=LONGEST):
    """
    Return the Cells of one case, each method's in order from coarse to fine.

    jobs: [(name, [(setting, prepare)])], prepare() gives a Run or raises; judge(state): error;
    report(text): called with what was left out and why; longest: see LONGEST [s].
    """
    cells = []
    for name, settings in jobs:
        for method, group in itertools.groupby(settings, lambda job: job[0].method):
            found, reasons = series(name, list(group), judge, longest)
            if not any(math.isfinite(cell.error) for cell in found):
                report(f'{name} {method}: ' + (reasons[-1] if reasons else 'no finite result'))
            cells += found
    gc.collect()
    gc.disable()
    for number in range(rounds):
        # The many settings that are far from the cheapest at every level need no best time.
        for cell in cells if number < 1 else contenders(cells):
            burst(cell)
    gc.enable()
    for cell in cells:
        cell.run = None
    return cells


def series(name, jobs, judge, longest):
    """Return the Cells of one method, as far as it makes sense, and why settings failed."""
    cells, reasons, best = [], [], math.inf
    for setting, prepare in jobs:
        try:
            cell = Cell(name, setting, prepare())
        except Exception as reason:  # whatever is raised: that setting does not exist
            reasons.append(one_line(reason))
            continue
        before = next((other.seconds for other in reversed(cells) if other.run), 0.0)
        cells.append(cell)
        try:
            cell.error = first_run(cell, judge, before)
        except Exception as reason:  # whatever is raised: that run failed, others may not
            reasons.append(one_line(reason))
            cell.run, cell.seconds = None, math.inf
            continue
        # Finer settings only cost more once rounding is what is left of the error.
        hopeless = cell.seconds > ONCE and best < 1e-3 and not cell.error < best
        if hopeless or cell.seconds > longest / 1.8:
            break
        best = min(best, cell.error)
    return cells, reasons


def one_line(reason):
    return (str(reason).splitlines() or [repr(reason)])[0][:200]


def first_run(cell, judge, before):
    """Run a cell for the first time; before: the time of the setting before it [s], or 0."""
    result = cell.time()
    if cell.seconds > 10.0 * before + 0.01:
        # That was the compiler: with the first setting, or with one that needs other code.
        cell.seconds, cell.spent = math.inf, 0.0
        result = cell.time()
    state = cell.run.state(result)
    return math.inf if state is None else judge(state)


def burst(cell):
    """Run a few times in a row, unless it takes too long."""
    if cell.run is None or cell.seconds > ONCE:
        return
    end = cell.spent + BURST
    while cell.spent < min(end, MOST_FOR_ONE):
        cell.time()


def contenders(cells):
    """Return the cells that may come out as the cheapest of their peer at some level."""
    kept = []
    for name in dict.fromkeys(cell.peer for cell in cells):
        own = of_peer(cells, name)
        best = {level: cheapest(own, level) for level in LEVELS}
        kept += [cell for cell in own
                 if any(cell.error <= level and cell.seconds <= 1.5 * found.seconds
                        for level, found in best.items() if found)]
    return kept


def end_error(case, reference):
    """Return the judge of end states."""
    return lambda state: error(case.scene, state, reference)
