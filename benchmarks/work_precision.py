# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Run time against error: dynsim_ros beside every engine that is installed, on one core.

Usage: python benchmarks/work_precision.py [--quick] [--scenes S1,S2] [--peers heyoka,scipy]
[--rounds N] [--output FOLDER]; writes work_precision.csv, .md and .png. README.md beside this file
tells what is measured and how. --quick writes nothing: S1, S2 and S3q against heyoka and
numbalsoda; its last line has the lowest ratio for each error.
"""

import argparse
from functools import partial
from pathlib import Path
import sys
import time
import warnings

from cases import CASES
from levels import LEVELS, ratio
from measure import end_error, LONGEST, measure, use_one_core
import numpy as np
import peers
from quiet import silence_libraries
from reference import reference_end, reference_samples
import tables

QUICK = {'scenes': ('S1', 'S2', 'S3q'), 'peers': ('heyoka', 'numbalsoda')}
# Engines that take much longer than the others are measured on these only, unless named.
SLOW = ('scipy', 'mujoco', 'drake', 'pybullet')
SLOW_SCENES = ('S1', 'S2', 'S3q', 'S3q8', 'chain2', 'flight')
# Case, rate [1/s]: sampled runs, all of whose samples must have the error.
SAMPLED = ('S2', 1000.0)


def usable(names, report):
    """Return ({name: module}, versions) of the peers that are there; report the others."""
    found, versions = {}, []
    for name in names:
        module = peers.peer(name)
        try:
            versions.append(f'{name} {module.available()}'.replace('ours', 'dynsim_ros'))
            found[name] = module
        except peers.Unavailable as reason:
            report(f'{name}: {reason}')
    return found, versions


def run_case(case, modules, rounds, report, longest):
    """Return the Cells of a case."""
    jobs = []
    for name, module in modules.items():
        if reason := module.supports(case):
            if name not in peers.NOT_COUNTED:
                report(f'{case.name}: {name}: {reason}')
            continue
        jobs.append((name, [(setting, partial(module.prepare, case, setting))
                            for setting in module.settings(case)]))
    return measure(jobs, rounds, end_error(case, reference_end(case)),
                   lambda text: report(f'{case.name}: {text}'), longest)


def run_sampled(modules, rounds, report):
    """Return (title, Cells) of the sampled run."""
    case, rate = CASES[SAMPLED[0]], SAMPLED[1]
    times = np.arange(round(case.duration * rate) + 1) / rate
    expected = reference_samples(case, times)

    jobs = [(name, [(setting, partial(module.prepare_samples, case, setting, times))
                    for setting in module.settings(case)])
            for name, module in modules.items() if hasattr(module, 'prepare_samples')]
    title = f'{case.name} sampled at {rate:g} Hz'
    return title, measure(jobs, rounds, end_error(case, expected),
                          lambda text: report(f'{title}: {text}'), 1.0)


def lowest(results, names):
    """Return the line of the lowest ratio for each error."""
    texts = []
    for level in LEVELS:
        ratios = {case: ratio(cells, level, names)[2] for case, cells in results.items()}
        ratios = {case: value for case, value in ratios.items() if value is not None}
        if ratios:
            case = min(ratios, key=ratios.get)
            texts.append(f'{level:.0e} {ratios[case]:.2f} ({case})'.replace('e-0', 'e-'))
    return 'lowest ratio per error: ' + (', '.join(texts) or 'none')


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('--quick', action='store_true',
                        help='S1, S2, S3q against heyoka and numbalsoda, no files')
    parser.add_argument('--scenes', type=lambda text: text.split(','), help='cases, with commas')
    parser.add_argument('--peers', type=lambda text: text.split(','), help='peers, with commas')
    parser.add_argument('--rounds', type=int, default=20, help='timed rounds (default 20)')
    parser.add_argument('--output', type=Path, default=Path(__file__).parent,
                        help='folder for the results (default: that of this file)')
    options = parser.parse_args()
    chosen = QUICK if options.quick else {'scenes': tuple(CASES), 'peers': peers.NAMES[1:]}
    options.peers_named = bool(options.peers)
    options.scenes = options.scenes or chosen['scenes']
    options.peers = options.peers or chosen['peers']
    for given, known, what in ((options.scenes, CASES, 'scenes'), (options.peers, peers.NAMES,
                                                                   'peers')):
        if unknown := [name for name in given if name not in known]:
            parser.error(f"--{what}: '{unknown[0]}' is not known; known are {', '.join(known)}")
    return options


def main():
    options = arguments()
    silence_libraries()
    # scipy says of every tolerance that it finds too small what it uses instead.
    warnings.simplefilter('ignore')
    use_one_core()
    left_out, results = [], {}

    def report(text):
        left_out.append(text)
        print(f'left out: {text}', flush=True)

    modules, versions = usable(['ours', *(name for name in options.peers if name != 'ours')],
                               report)
    for name in options.scenes:
        start = time.time()
        used = {peer: module for peer, module in modules.items()
                if options.peers_named or peer not in SLOW or name in SLOW_SCENES}
        results[name] = run_case(CASES[name], used, options.rounds, report,
                                 0.1 if options.quick else LONGEST)
        print(f'\n{name} ({time.time() - start:.0f} s)')
        print('\n'.join(tables.case_table(results[name])), flush=True)
    notes = {name: f'{CASES[name].note}, {CASES[name].duration:g} s' for name in results}
    if not options.quick:
        if SAMPLED[0] in options.scenes:
            title, cells = run_sampled(modules, options.rounds, report)
            results[title], notes[title] = cells, 'the worst error of all samples counts'
            print(f'\n{title}\n' + '\n'.join(tables.case_table(cells)), flush=True)
        write(options.output, results, notes, versions, left_out)
    print(lowest(results, [name for name in modules
                           if name != 'ours' and name not in peers.NOT_COUNTED]))


def write(folder, results, notes, versions, left_out):
    versions = [*tables.base_versions(), *versions]
    tables.write_csv(folder / 'work_precision.csv', results)
    (folder / 'work_precision.md').write_text(
        tables.markdown(results, notes, versions, left_out), encoding='utf-8')
    tables.plot(results, folder / 'work_precision.png')


if __name__ == '__main__':
    sys.exit(main())
