# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
How punctual ticks at 1 kHz are with each of the options of real_time, on a machine idle and busy.

Usage: python benchmarks/real_time.py [--rounds N] [--seconds S]; writes real_time.md. Busy: as
many processes that only compute as there are processors. Beside it the naive node of node.py.
"""

import argparse
from contextlib import contextmanager, nullcontext
from datetime import date
import os
from pathlib import Path
from statistics import median
import subprocess
import sys
import time

from node import RATE, SETTLE
import node_processes
from node_processes import listening, running
import tables

CPU = float(max(os.sched_getaffinity(0)))
# What a row says: the kind of node and its parameters.
KINDS = {
    'the naive node': ('naive', {}),
    'as it is by default': ('ours', {}),
    '`real_time.priority` 0': ('ours', {'real_time__priority': 0.0}),
    '`real_time.spin` 0.0001': ('ours', {'real_time__spin': 1e-4}),
    '`real_time.spin` 0.0003': ('ours', {'real_time__spin': 3e-4}),
    '`real_time.priority` 50': ('ours', {'real_time__priority': 50.0}),
    f'`real_time.cpu` {CPU:g}': ('ours', {'real_time__cpu': CPU}),
    '`real_time.lock_memory`': ('ours', {'real_time__lock_memory': True}),
    '`priority` 50 and `spin` 0.0003': ('ours', {'real_time__priority': 50.0,
                                                 'real_time__spin': 3e-4})}
HEAD = """\
# Real-time options

`python benchmarks/real_time.py`: by how much intervals between the poses of the default scene at
1 kHz, six topics heard by one process, are off 1 ms when they are sent; medians of {rounds} runs
of {seconds:g} s, in alternation. Busy: beside as many processes that only compute as there are
processors. The priority {granted} granted here. {machine}, {date}.

| | idle: p50 [µs] | p99 [µs] | longest [ms] | CPU [%] | busy: p50 [µs] | p99 [µs] | longest [ms] |
|---|---|---|---|---|---|---|---|
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('--rounds', type=int, default=3)
    parser.add_argument('--seconds', type=float, default=4.0)
    options = parser.parse_args()
    mark = node_processes.keep_to_this_machine()
    found = {(name, is_busy): [] for name in KINDS for is_busy in (False, True)}
    for _ in range(options.rounds):
        for (name, is_busy), runs in found.items():
            with busy() if is_busy else nullcontext():
                runs.append(measured(*KINDS[name], options.seconds))
    mark.close()
    text = HEAD.format(
        rounds=options.rounds, seconds=options.seconds, date=date.today().isoformat(),
        machine=tables.machine().partition('; load')[0].replace(', one used', ''),
        granted='was' if is_granted() else 'was not')
    for name in KINDS:
        idle, loaded = ([median(part) for part in zip(*found[name, is_busy])]
                        for is_busy in (False, True))
        text += f'| {name} | ' + ' | '.join(map(shown, [*idle, *loaded[:3]])) + ' |\n'
    print(text, end='')
    Path(__file__).with_suffix('.md').write_text(text, encoding='utf-8')


def shown(value):
    """Return a number with three digits, or all that it has before the point."""
    return f'{value:.0f}' if value >= 100 else f'{value:.3g}'


def measured(kind, parameters, seconds):
    """Run a node; return p50, p99 [us] and longest [ms] deviation, and its CPU [% of a core]."""
    with running(kind, RATE, **parameters) as node, listening(node) as subscriber:
        time.sleep(SETTLE)
        heard = subscriber.measure(seconds, RATE)
    off = heard['sending']
    return off['p50'], off['p99'], 1e-3 * off['max'], 100 * heard['node cpu']


@contextmanager
def busy():
    """Keep all processors busy until the block is left."""
    others = [subprocess.Popen([sys.executable, '-c', 'while True: pass'])
              for _ in os.sched_getaffinity(0)]
    try:
        yield
    finally:
        for other in others:
            other.kill()
            other.wait()


def is_granted():
    """Tell whether a process may have a priority of SCHED_FIFO here."""
    trial = 'import os; os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(50))'
    return not subprocess.run([sys.executable, '-c', trial], stderr=subprocess.DEVNULL).returncode


if __name__ == '__main__':
    main()
