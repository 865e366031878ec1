# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Work against error as instruction counts, which do not depend on what else the machine does.

Usage: python benchmarks/instructions.py [--scenes S1,S2] [--peers heyoka] [--output FOLDER];
writes instructions.md and .csv. Needs valgrind and gcc. Each engine has two processes for a
scene: in the first, every setting is run once for its error, and what can be kept of the compiled
code is kept; in the second, under valgrind's callgrind, the settings that may be the cheapest
ones are compiled or loaded, run to warm up, and only then counted.
"""

import argparse
import json
import math
import os
from pathlib import Path
import platform
import shutil
import subprocess
import sys
import tempfile

from cases import CASES
import instructions_tables
from measure import Cell
import peers
from peers import Setting
import tables
from work_precision import QUICK, usable

WORK = Path(__file__).with_name('instructions_work.py')
# One processor for all: valgrind knows vectors of four doubles, but none of eight.
PROCESSOR = {'NUMBA_CPU_NAME': 'haswell', 'NUMBA_CPU_FEATURES': ''}
# The same hashes give the same counts; the last one keeps ROS's packages from PyPI from starting
# Python once more, outside valgrind.
ENVIRONMENT = {'PYTHONHASHSEED': '0', 'OPENBLAS_NUM_THREADS': '1',
               '_ROS_WHEELS_BOOTSTRAP_COMPLETE': '1'}
MARKS = """\
#include <valgrind/callgrind.h>
void begin(void) { CALLGRIND_START_INSTRUMENTATION; CALLGRIND_ZERO_STATS; }
void end(void) { CALLGRIND_DUMP_STATS; CALLGRIND_STOP_INSTRUMENTATION; }
"""


class Failed(Exception):
    """Why another process gave no result."""


def compile_marks(folder):
    """Compile what tells callgrind when to count; returns None, or what is missing."""
    for program, what in (('valgrind', 'counts the instructions'), ('gcc', 'compiles the marks')):
        if shutil.which(program) is None:
            return (f'error: {program} was not found, which {what}; install it '
                    f'(apt install {program})')
    done = subprocess.run(['gcc', '-O2', '-shared', '-fPIC', '-x', 'c', '-', '-o',
                           f'{folder}/marks.so'], input=MARKS, capture_output=True, text=True)
    return None if done.returncode == 0 else (
        'error: gcc cannot compile with valgrind/callgrind.h '
        f'({(done.stderr.splitlines() or ["no reason given"])[0]}); install the headers '
        '(apt install valgrind libc6-dev)')


def ask(folder, name, *arguments, counted=False):
    """Return what a function of instructions_work.py returns in a process of its own."""
    under = ['valgrind', '-q', '--tool=callgrind', '--instr-atstart=no',
             f'--callgrind-out-file={folder}/counts'] if counted else []
    processor = PROCESSOR if platform.machine() == 'x86_64' else {}
    done = subprocess.run(
        [*under, sys.executable, WORK, json.dumps([name, folder, arguments])],
        env={**os.environ, **ENVIRONMENT, **processor}, capture_output=True, text=True)
    if done.returncode:
        lines = done.stderr.strip().splitlines() or [f'exit status {done.returncode}']
        raise Failed(('under valgrind: ' if counted else '') + lines[-1][:200])
    return json.loads(done.stdout)


def count_engine(folder, scene, engine, report):
    """Return the Cells of an engine on a scene, with instructions as their seconds."""
    try:
        found, left_out = ask(folder, 'choose', scene, engine)
        wanted = [(method, value) for method, value, _, chosen in found if chosen]
        counts = dict(zip(wanted, ask(folder, 'runs', scene, engine, wanted, counted=True)))
    except Failed as reason:
        report(f'{scene}: {engine}: {reason}')
        return []
    for text in left_out:
        report(f'{scene}: {text}')
    cells = []
    for method, value, error, _ in found:
        error, count = counts.get((method, value), (error, math.inf))
        cells.append(Cell(engine, Setting(method, value), error=error, seconds=count))
    return cells


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    for name in ('scenes', 'peers'):
        parser.add_argument(f'--{name}', type=lambda text: text.split(','), default=QUICK[name],
                            help=f'{name}, with commas (default {",".join(QUICK[name])})')
    parser.add_argument('--output', type=Path, default=Path(__file__).parent,
                        help='folder for the results (default: that of this file)')
    options = parser.parse_args()
    for given, known, what in ((options.scenes, CASES, 'scenes'),
                               (options.peers, peers.NAMES[1:], 'peers')):
        if unknown := [name for name in given if name not in known]:
            parser.error(f"--{what}: '{unknown[0]}' is not known; known are {', '.join(known)}")
    return options


def main():
    options = arguments()
    left_out = []

    def report(text):
        left_out.append(text)
        print(f'left out: {text}', flush=True)

    with tempfile.TemporaryDirectory() as folder:
        if missing := compile_marks(folder):
            return missing
        modules, versions = usable(['ours', *options.peers], report)
        results, counted = {}, {}
        for scene in options.scenes:
            results[scene] = []
            for engine in modules:
                results[scene] += count_engine(folder, scene, engine, report)
                print(f'{scene}: {engine} counted', flush=True)
        try:
            for name in ('steps', 'removed'):
                # The first one fills the cache of compiled code.
                ask(folder, name)
                counted[name] = ask(folder, name, counted=True)
        except Failed as reason:
            return f'error: {reason}'
    version = subprocess.run(['valgrind', '--version'], capture_output=True, text=True).stdout
    versions = [*tables.base_versions(), version.strip().replace('-', ' '), *versions]
    text = instructions_tables.markdown(results, *counted.values(), versions, left_out)
    (options.output / 'instructions.md').write_text(text, encoding='utf-8')
    instructions_tables.write_csv(options.output / 'instructions.csv', results,
                                  *counted.values())
    print(text)
    return None


if __name__ == '__main__':
    sys.exit(main())
