# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
What the node costs: beside the naive node (naive_node.py), alternating, medians of several runs.

Usage: python benchmarks/node.py [--quick] [--rounds N] [--output FOLDER]; writes node.json,
node.md and node.png. --quick takes two minutes and writes nothing unless a folder is given.
"""

import argparse
import os
from pathlib import Path
import time

import node_processes
from node_processes import listening, running
import node_recording
import node_tables
import node_tick

RATE, COMMANDS = 1000, 50
LADDER = {'ours': (10000, 8000, 6000, 5000, 4000, 3000, 2000, 1000),
          'naive': (3000, 2500, 2000, 1500, 1000, 750, 500, 250)}
QUICK_LADDER = {'ours': (10000, 5000, 2000, 1000), 'naive': (2000, 1000, 500)}
PROBE = ('sphere/pose',)
AUDIENCES = {'six topics': tuple(node_processes.TOPICS), 'one topic': PROBE}
# How long a node settles after its start or after somebody has come or gone [s].
SETTLE = 1.0


def measured(kind, seconds, record=False):
    """Run a node without and with a subscriber; return shares of a core, intervals, latencies."""
    parameters = {'record__enable': True} if record else {}
    with running(kind, RATE, **parameters) as node:
        with listening(node) as subscriber:
            time.sleep(SETTLE)
            heard = subscriber.measure(seconds, RATE)
            commanded = subscriber.measure(seconds, RATE, COMMANDS)
        time.sleep(SETTLE)
        alone = node.share(seconds)
    return {'alone': alone, **heard, 'latency': commanded['latency']}


def highest_rate(kind, ladder, seconds, topics, tries):
    """Return the highest rate [Hz] of a ladder held in one of some tries, and what was seen."""
    seen = {}
    for rate in ladder:
        seen[rate] = []
        for _ in range(tries):
            with running(kind, rate) as node, listening(node, topics) as subscriber:
                time.sleep(SETTLE)
                seen[rate].append(subscriber.measure(seconds, rate)['topics'][PROBE[0]])
            last = seen[rate][-1]
            if last['missed'] == 0 and (kind == 'naive' or last['gaps'] == 0):
                return {'held': rate, 'seen': seen}
    return {'held': 0, 'seen': seen}


def memory(ticks):
    """Publish so many ticks as fast as possible; return the memory before and after [bytes]."""
    with running('ours', RATE, real_time_factor=0.0) as node, \
            listening(node, PROBE) as subscriber:
        done, seen = 0, []
        while done < 1.1 * ticks:
            done += subscriber.measure(2.0, RATE)['topics'][PROBE[0]]['sent']
            seen.append((done, node.memory()))
    # What the first tenth needs is the start's.
    start = next(size for count, size in seen if count >= 0.1 * ticks)
    return {'ticks': done, 'before': start, 'after': seen[-1][1]}


def run(rounds, quick):
    """Return everything that is measured."""
    runs, seconds = {'ours': [], 'naive': [], 'recording': []}, 2.0 if quick else 5.0
    for number in range(rounds):
        print(f'round {number + 1} of {rounds}', flush=True)
        runs['naive'].append(measured('naive', seconds))
        runs['ours'].append(measured('ours', seconds))
        runs['recording'].append(measured('ours', seconds, record=True))
    ladders, held, tries = (QUICK_LADDER, 2.0, 1) if quick else (LADDER, 10.0, 2)
    rates = {}
    for name, topics in AUDIENCES.items():
        print(f'highest rate, {name}', flush=True)
        rates[name] = {kind: highest_rate(kind, ladder, held, topics, tries)
                       for kind, ladder in ladders.items()}
    print('memory, recording, ticks', flush=True)
    return {'runs': runs, 'rates': rates, 'memory': memory(50_000 if quick else 1_000_000),
            'recording': node_recording.measure(min(rounds, 3)),
            'tick': node_tick.measure(rounds)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('--quick', action='store_true', help='two minutes, written nowhere')
    parser.add_argument('--rounds', type=int, default=None, help='runs of each node')
    parser.add_argument('--output', type=Path, default=None,
                        help='folder for the results (default: that of this file)')
    options = parser.parse_args()
    rounds = options.rounds or (1 if options.quick else 5)
    mark = node_processes.keep_to_this_machine()
    load = os.getloadavg()[0]
    results = run(rounds, options.quick)
    mark.close()
    # As they are kept, so that tables and plot can be made of that again.
    results = node_tables.rounded({'about': node_tables.about(load, rounds),
                                   'rows': node_tables.rows(results), **results})
    text = node_tables.markdown(results)
    print(text)
    if options.output or not options.quick:
        node_tables.write(options.output or Path(__file__).parent, results, text)


if __name__ == '__main__':
    main()
