# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The results of instructions.py, as Markdown and as CSV."""

import csv
import math

from levels import LEVELS, ratio
from peers import NOT_COUNTED
import skipping
import tables

HEAD = """\
# Instructions against error

Made by `make bench-instructions` (instructions.py); scenes, errors and engines as in
[README.md](README.md). What a core executes in a run, counted by valgrind's callgrind: it does not
depend on what else the machine does, and hardly on the machine. It is no time: some instructions
take longer than others, and one that computes four numbers at once counts as one. valgrind has no
AVX-512, so whatever is compiled for a scene is compiled for AVX2. Only the run is counted, with
its call from Python, once everything is compiled and has been run before.
"""


def runs_table(results):
    """Return the lines of the table of whole runs; results: {scene: Cells}."""
    lines = ['| scene | | ' + ' | '.join(f'{level:.0e}'.replace('e-0', 'e-')
                                         for level in LEVELS) + ' |', '|---|---|' + '---|' * 4]
    for scene, cells in results.items():
        names = [name for name in dict.fromkeys(cell.peer for cell in cells) if name != 'ours']
        counted = [name for name in names if name not in NOT_COUNTED]
        rows = {'**ratio to the best peer**': [tables.ratio_text(cells, level, counted)
                                               for level in LEVELS]}
        by_auto = [cell for cell in cells if cell.setting.method == 'auto']
        rows['dynsim_ros, best'] = [run_text(cells, level, 'ours') for level in LEVELS]
        rows['dynsim_ros, auto'] = [run_text(by_auto, level, 'ours') for level in LEVELS]
        rows |= {name: [run_text(cells, level, name) for level in LEVELS] for name in names}
        lines += [f'| {scene} | {name} | ' + ' | '.join(row) + ' |' for name, row in rows.items()]
    return lines


def run_text(cells, level, name):
    """Return the count of the named engine's best setting, and the ratio if it is a peer's."""
    _, best, value = ratio(cells, level, [name])
    if best is None:
        return '–'
    text = f'{digits(best.seconds / 1e3)} {best.setting.method}'
    return text if name == 'ours' or value is None else f'{text} ({value:.3g}×)'


def digits(value):
    """Return a number with three digits."""
    return f'{float(f"{value:.3g}"):.10g}'


def markdown(results, steps, removed, versions, left_out):
    lines = [HEAD, f'Machine: {tables.machine()}.', 'Versions: ' + ', '.join(versions) + '.', '']
    if left_out:
        lines += ['Left out:', *(f'- {text}' for text in dict.fromkeys(left_out)), '']
    lines += ['## Whole runs', '',
              'Thousands of instructions for a whole run, each with the setting of least that '
              'reaches the error\nand whose next three finer settings reach it, too. The ratio, '
              'and what is in brackets, is the count\nof the (best) peer over that of '
              'dynsim_ros: above 1 dynsim_ros is ahead. "–": the error is not reached.', '',
              *runs_table(results), '', '## Steps of dynsim_ros', '',
              'Whole runs of 10 s over their steps, rejected ones among them.', '',
              '| method | scene | tolerance or step | steps | instructions a step |',
              '|---|---|---|---|---|']
    lines += [f'| {method} | {scene} | {value:g} | {number} | {count / number:.0f} |'
              for scene, method, value, number, count in steps]
    kinds = dict.fromkeys(kind for kind, *_ in removed)
    each = {(kind, name): count / number for kind, name, number, count in removed}
    lines += ['', '## What a scene lacks is not computed', '',
              'Instructions a step of rk4 on the scenes of [skipping.md](skipping.md): all terms, '
              'each of them\nremoved in turn, several of them removed. The percentages are of '
              '"full".', '',
              '| removed | ' + ' | '.join(kinds) + ' |', '|---|' + '---|' * len(kinds)]
    for name in dict.fromkeys(name for _, name in each):
        lines.append(f'| {name} | ' + ' | '.join(
            f'{each[kind, name]:.0f} ({each[kind, name] / each[kind, "full"]:.0%})'
            for kind in kinds) + ' |')
    return '\n'.join(lines) + '\n'


def write_csv(path, results, steps, removed):
    with path.open('w', encoding='utf-8', newline='') as file:
        writer = csv.writer(file, lineterminator='\n')
        writer.writerow(['scene', 'engine', 'method', 'tolerance or step', 'removed', 'error',
                         'steps', 'instructions'])
        for scene, cells in results.items():
            writer.writerows(
                (scene, cell.peer, cell.setting.method, f'{cell.setting.value:.6g}', '',
                 f'{cell.error:.3g}', '', cell.seconds)
                for cell in cells if math.isfinite(cell.seconds))
        writer.writerows((scene, 'ours', method, value, '', '', number, count)
                         for scene, method, value, number, count in steps)
        writer.writerows((kind, 'ours', 'rk4', skipping.STEP, name, '', number, count)
                         for kind, name, number, count in removed)
