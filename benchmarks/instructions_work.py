# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
What instructions.py lets other processes do: choosing settings, and counting under valgrind.

Usage: python benchmarks/instructions_work.py JSON: [what, folder with marks.so, arguments]; prints
the result as JSON.
"""

import ctypes
from functools import partial
import gc
import json
import math
from pathlib import Path
import sys
import warnings

from cases import CASES
from measure import contenders, end_error, measure
import peers
from peers import ours, Setting
from quiet import silence_libraries
from reference import reference_end
import skipping

# Settings of methods of which one run takes longer than this are too dear to be counted [s].
LONGEST = 0.1
STEPS = (('S2', Setting('explicit_euler', 1e-3)), ('S2', Setting('semi_implicit_euler', 1e-3)),
         ('S2', Setting('leapfrog', 1e-3)), ('S2', Setting('rk4', 1e-3)),
         ('S1', Setting('extrapolation', 1e-9)), ('S2', Setting('extrapolation', 1e-9)))


class Counter:
    """Counts the instructions of calls where callgrind runs this process, elsewhere gives nan."""

    def __init__(self, folder):
        self._folder, self._number, self._idle = Path(folder), 0, 0
        self._marks = ctypes.CDLL(str(self._folder / 'marks.so'))
        for _ in range(3):
            self._idle += self(lambda: None)[1]

    def __call__(self, run):
        """Return (result, instructions) of a second call of a function."""
        run()
        self._marks.begin()
        result = run()
        self._marks.end()
        self._number += 1
        path = self._folder / f'counts.{self._number}'
        if not path.exists():
            return result, math.nan
        totals = [line for line in path.read_text(encoding='utf-8').splitlines()
                  if line.startswith('totals:')]
        path.unlink()
        return result, int(totals[0].split()[1]) - self._idle


def choose(scene, engine):
    """Return ([(method, value, error, may be the cheapest)], what was left out)."""
    case, module, left_out = CASES[scene], peers.peer(engine), []
    jobs = [(engine, [(setting, partial(module.prepare, case, setting))
                      for setting in module.settings(case)])]
    cells = measure(jobs, 1, end_error(case, reference_end(case)), left_out.append, LONGEST)
    by_auto = [cell for cell in cells if cell.setting.method == 'auto']
    wanted = {cell.setting for cell in (*contenders(cells), *contenders(by_auto))}
    return [(cell.setting.method, cell.setting.value, cell.error, cell.setting in wanted)
            for cell in cells], left_out


def count_runs(counter, scene, engine, settings):
    """Return [(error, instructions)] of settings [(method, value)]."""
    case, module, found = CASES[scene], peers.peer(engine), []
    judge = end_error(case, reference_end(case))
    # It times several equal ones to take the fastest: they execute the same instructions.
    module.INSTANCES = 1
    for method, value in settings:
        run = module.prepare(case, Setting(method, value))
        result, count = counter(run.run)
        state = run.state(result)
        found.append((math.inf if state is None else judge(state), count))
    return found


def count_steps(counter):
    """Return [(scene, method, tolerance or step, attempted steps, instructions)]."""
    rows = []
    for scene, setting in STEPS:
        propagator = ours.propagator(CASES[scene], setting)
        _, count = counter(partial(propagator.end_state, CASES[scene].duration))
        steps = propagator.counts['steps'] + propagator.counts['rejected']
        rows.append((scene, setting.method, setting.value, steps, count))
    return rows


def count_removed(counter):
    """Return [(body, what was removed, steps, instructions)] of rk4."""
    rows = []
    for kind in skipping.BODIES:
        for name, (scene, works) in skipping.variants(kind).items():
            run = skipping.Run(scene, works, 'rk4')
            _, count = counter(run.run)
            rows.append((kind, name, run.counts[0], count))
    return rows


WORK = {'choose': choose, 'runs': count_runs, 'steps': count_steps, 'removed': count_removed}


def main():
    name, folder, arguments = json.loads(sys.argv[1])
    # scipy says of every tolerance that it finds too small what it uses instead.
    warnings.simplefilter('ignore')
    silence_libraries()
    if name != 'choose':
        gc.disable()
        arguments.insert(0, Counter(folder))
    print(json.dumps(WORK[name](*arguments)))


if __name__ == '__main__':
    sys.exit(main())
