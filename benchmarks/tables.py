# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The results of work_precision.py: as CSV, as a Markdown table of ratios and as a plot."""

import csv
import math
import os
from pathlib import Path
import platform

from levels import cheapest, LEVELS, of_peer, ratio
import numba
import numpy as np
from peers import NOT_COUNTED

HEAD = """\
# Run time against error

Made by `make bench`; what is measured, and how, stands in [README.md](README.md).
Milliseconds for a whole run, each the cheapest setting that reaches the error and whose next three
finer settings reach it, too. The ratio, and what is in brackets, is the time of the (best) peer
over the time of dynsim_ros: above 1 dynsim_ros is ahead. "–": the error is not reached.
"""


def write_csv(path, results):
    """Write every setting that was run."""
    with Path(path).open('w', encoding='utf-8', newline='') as file:
        writer = csv.writer(file, lineterminator='\n')
        writer.writerow(['case', 'peer', 'method', 'tolerance or step', 'error', 'milliseconds'])
        for name, cells in results.items():
            for cell in cells:
                writer.writerow([name, cell.peer, cell.setting.method,
                                 f'{cell.setting.value:.6g}', f'{cell.error:.3g}',
                                 f'{1e3 * cell.seconds:.5g}'])


def markdown(results, notes, versions, left_out):
    """Return the text of the table."""
    lines = [HEAD, f'Machine: {machine()}.', 'Versions: ' + ', '.join(versions) + '.', '']
    if left_out:
        lines += ['Left out:', *(f'- {text}' for text in dict.fromkeys(left_out)), '']
    for name, cells in results.items():
        lines += [f'## {name}', '', notes[name] + '.', '', *case_table(cells), '']
    return '\n'.join(lines)


def case_table(cells):
    names = [name for name in dict.fromkeys(cell.peer for cell in cells) if name != 'ours']
    counted = [name for name in names if name not in NOT_COUNTED]
    lines = ['| | ' + ' | '.join(f'{level:.0e}'.replace('e-0', 'e-') for level in LEVELS) + ' |',
             '|---|' + '---|' * len(LEVELS)]
    auto = [cell for cell in cells if (cell.peer, cell.setting.method) == ('ours', 'auto')]
    rows = {'**ratio to the best peer**': [ratio_text(cells, level, counted) for level in LEVELS]}
    if any(cell.peer == 'ours' for cell in cells):
        rows['dynsim_ros, best'] = best_texts(of_peer(cells, 'ours'))
    if auto:
        rows['dynsim_ros, auto'] = best_texts(auto)
    rows |= {name: [peer_text(cells, level, name) for level in LEVELS] for name in names}
    return lines + [f'| {name} | ' + ' | '.join(row) + ' |' for name, row in rows.items()]


def best_texts(cells):
    found = [cheapest(cells, level) for level in LEVELS]
    several = len({cell.setting.method for cell in cells}) > 1
    return ['–' if cell is None else milliseconds(cell)
            + (f' {cell.setting.method}' if several else '') for cell in found]


def peer_text(cells, level, name):
    ours, best, value = ratio(cells, level, [name])
    if best is None:
        return '–'
    methods = {cell.setting.method for cell in of_peer(cells, name)}
    text = milliseconds(best) + (f' {best.setting.method}' if len(methods) > 1 else '')
    return text if value is None else f'{text} ({value:.3g}×)'


def milliseconds(cell):
    value = 1e3 * cell.seconds
    return f'{value:.4f}' if value < 0.1 else f'{value:.3g}' if value < 1e3 else f'{value:.0f}'


def ratio_text(cells, level, peers):
    ours, best, value = ratio(cells, level, peers)
    if value is not None:
        return f'**{value:.3g}** ({best.peer})'
    return f'only {(ours or best).peer}' if ours or best else '–'


def machine():
    """Describe the machine in words."""
    info = Path('/proc/cpuinfo')
    model = platform.processor()
    if info.exists():
        names = [line.partition(':')[2].strip()
                 for line in info.read_text(encoding='utf-8').splitlines()
                 if line.startswith('model name')]
        model = names[0] if names else model
    return (f'{model}, {os.cpu_count()} cores, one used; {platform.system()} '
            f'{platform.machine()}; load {os.getloadavg()[0]:.1f}')


def base_versions():
    return [f'Python {platform.python_version()}', f'numpy {np.__version__}',
            f'numba {numba.__version__}']


def plot(results, path):
    """Draw run time against error, a panel a case."""
    import matplotlib
    matplotlib.use('Agg')
    from matplotlib import pyplot

    columns = min(4, len(results))
    rows = -(-len(results) // columns)
    figure, axes = pyplot.subplots(rows, columns, figsize=(4.2 * columns, 3.6 * rows),
                                   squeeze=False)
    names = list(dict.fromkeys(cell.peer for cells in results.values() for cell in cells))
    colours = {name: f'C{i}' for i, name in enumerate(names)}
    for ax, (case, cells) in zip(axes.flat, results.items()):
        draw(ax, cells, colours)
        ax.set(title=case, xlabel='error at the end', xlim=(3, 1e-15), ylabel='run time [ms]')
    for ax in list(axes.flat)[len(results):]:
        ax.set_axis_off()
    handles = [pyplot.Line2D([], [], color=colours[name], marker='o', markersize=3,
                             label='dynsim_ros' if name == 'ours' else name) for name in names]
    figure.legend(handles=handles, loc='upper center', ncols=len(names), fontsize=9)
    figure.tight_layout(rect=(0, 0, 1, 1 - 0.3 / rows / 4))
    figure.savefig(path, dpi=80)


def draw(ax, cells, colours):
    """Draw one line for each peer: the runs that no other of its runs beats in time and error."""
    for peer in dict.fromkeys(cell.peer for cell in cells):
        points = sorted((cell.error, 1e3 * cell.seconds) for cell in of_peer(cells, peer)
                        if 0 < cell.error < 3 and math.isfinite(cell.seconds))
        front = [point for i, point in enumerate(points)
                 if all(point[1] < other[1] for other in points[:i])]
        if front:
            ax.loglog(*zip(*front), '-o', color=colours[peer], markersize=2.5,
                      linewidth=1.8 if peer == 'ours' else 1.0,
                      zorder=3 if peer == 'ours' else 2)
    ax.grid(alpha=0.3)
