# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The results of stability.py: as CSV, as Markdown and as heat maps."""

from collections import Counter
import csv

from stability_cells import GRIDS, Parameters, UNITS, VALUES
import tables

# Okabe and Ito's colours, which everybody can tell apart, and what each outcome is worth.
OUTCOMES = {'ok': '#009E73', 'outside, and says so': '#F0E442', 'outside tolerance': '#E69F00',
            'energy grew': '#D55E00', 'not finite': '#000000', 'refused': '#56B4E9',
            'timeout': '#CC79A7', 'crash': '#7F3C5D', 'no reference': '#BBBBBB'}
HEAD = """\
# Stability far and wide

Made by `make bench-stability` (stability.py); what the outcomes mean stands in
[README.md](README.md). A sphere on a spring-damper in air, 0.1 s; what is not on the axes is as in
S2, the step of methods of fixed step is 1 ms.
"""


def write_csv(path, cells, references):
    """Write every cell."""
    names = list(VALUES)
    with path.open('w', encoding='utf-8', newline='') as file:
        writer = csv.writer(file, lineterminator='\n')
        writer.writerow(['grid', 'method', *names, 'outcome', 'error', 'allowed',
                         'relative change of energy', 'evaluations', 'milliseconds', 'reference',
                         'reason'])
        for cell in cells:
            writer.writerow([
                ' x '.join(cell.grid), cell.method,
                *(f'{getattr(cell.parameters, name):.6g}' for name in names), cell.outcome,
                *('' if value is None else f'{value:.3g}'
                  for value in (cell.error, cell.allowed, cell.energy_change)),
                '' if cell.work is None else cell.work, f'{1e3 * cell.seconds:.3g}',
                references[cell.grid, cell.parameters], cell.reason])


def markdown(cells, references, versions, missing, extra):
    """Return the text; extra: lines of the long runs."""
    count = Counter(references.values())
    lines = [HEAD, f'Machine: {tables.machine()}. ' + ', '.join(versions) + '.', '']
    lines += [f'Left out: {text}.' for text in missing]
    lines += ['References: ' + ', '.join(f'{how} in {n} cells' for how, n in count.items()) + '.',
              '', '## Outcomes', '', *outcome_table(cells), '', '## Grids', '']
    lines += [f'- {" × ".join(axes)}: [plot]({plot_name(axes)})' for axes in GRIDS]
    lines += ['', '## Cells in which a peer is ok and auto is not', '',
              'A peer is ok with an error of 1e-3.', '', *lost(cells), '',
              '## What auto refuses or does not reach, and why', '', *refusals(cells), '', *extra]
    return '\n'.join(lines).rstrip() + '\n'


def outcome_table(cells):
    """Return the lines of how often each method came to each outcome."""
    used = [name for name in OUTCOMES if any(cell.outcome == name for cell in cells)]
    lines = ['| method | ' + ' | '.join(used) + ' | slowest [s] |',
             '|---|' + '---|' * (len(used) + 1)]
    for method in dict.fromkeys(cell.method for cell in cells):
        own = [cell for cell in cells if cell.method == method]
        counts = Counter(cell.outcome for cell in own)
        lines.append(f'| {method} | ' + ' | '.join(str(counts[name] or '–') for name in used)
                     + f' | {max(cell.seconds for cell in own):.2f} |')
    return lines


def lost(cells):
    """Return the lines of the cells in which a peer does what auto does not."""
    by_place = {}
    for cell in cells:
        by_place.setdefault((cell.grid, cell.parameters), []).append(cell)
    lines = []
    for place, found in by_place.items():
        ahead = [f'{cell.method} (error {cell.error:.2g})' for cell in found
                 if cell.outcome == 'ok'
                 and cell.method.startswith(('MuJoCo', 'PyBullet', 'Drake'))]
        for cell in found:
            if ahead and cell.method.startswith('auto') and cell.outcome != 'ok':
                numbers = '' if cell.error is None else f' (error {cell.error:.2g})'
                lines.append(f'- {named(*place)}: {cell.method}: {cell.outcome}{numbers}; '
                             f'ok: {", ".join(ahead)}')
    return lines or ['None.']


def refusals(cells):
    """Return the lines of why auto refused."""
    lines = [f'- {named(cell.grid, cell.parameters)}: {cell.method}: {cell.reason or cell.outcome}'
             for cell in cells if cell.method.startswith('auto')
             and cell.outcome in ('refused', 'timeout', 'outside, and says so')]
    return lines or ['Nothing.']


def named(axes, parameters: Parameters):
    return ', '.join(f'{name} {getattr(parameters, name):g} {UNITS[name]}' for name in axes)


def plot_name(axes):
    return f'stability_{"_".join(axes)}.png'


def plots(cells, folder):
    """Draw a figure for each grid, a panel for each method."""
    import matplotlib
    matplotlib.use('Agg')
    from matplotlib import pyplot
    from matplotlib.colors import ListedColormap

    names, colours = list(OUTCOMES), ListedColormap(list(OUTCOMES.values()))
    methods = list(dict.fromkeys(cell.method for cell in cells))
    columns = min(6, len(methods))
    rows = -(-len(methods) // columns)
    for axes in GRIDS:
        figure, panels = pyplot.subplots(rows, columns, squeeze=False, sharex=True, sharey=True,
                                         figsize=(2.5 * columns + 0.5, 2.5 * rows + 0.8))
        for panel, method in zip(panels.flat, methods):
            own = {cell.parameters: names.index(cell.outcome) for cell in cells
                   if (cell.grid, cell.method) == (axes, method)}
            panel.imshow(picture(own, axes), cmap=colours, vmin=-0.5, vmax=len(names) - 0.5,
                         origin='lower', aspect='auto')
            ticks(panel, method, axes)
        for panel in list(panels.flat)[len(methods):]:
            panel.set_axis_off()
        used = dict.fromkeys(cell.outcome for cell in cells)
        handles = [pyplot.Rectangle((0, 0), 1, 1, color=colour, label=name)
                   for name, colour in OUTCOMES.items() if name in used]
        figure.legend(handles=handles, loc='upper center', ncols=len(handles), fontsize=9)
        figure.supxlabel(f'{axes[0]} [{UNITS[axes[0]]}]')
        figure.supylabel(f'{axes[1]} [{UNITS[axes[1]]}]')
        figure.tight_layout(rect=(0.015, 0, 1, 0.95))
        figure.savefig(folder / plot_name(axes), dpi=80)
        pyplot.close(figure)


def picture(own, axes):
    """Return the rows of a panel: the number of the outcome in each cell."""
    found = {tuple(getattr(parameters, name) for name in axes): number
             for parameters, number in own.items()}
    return [[found[x, y] for x in VALUES[axes[0]]] for y in VALUES[axes[1]]]


def short(value):
    mantissa, exponent = f'{value:.0e}'.split('e')
    return f'{mantissa}e{int(exponent)}' if value else '0'


def ticks(panel, method, axes):
    """Label a panel and draw thin lines between its cells."""
    x, y = (VALUES[name] for name in axes)
    panel.set_title(method, fontsize=9)
    panel.set_xticks(range(len(x)), [short(value) for value in x], rotation=90, fontsize=7)
    panel.set_yticks(range(len(y)), [short(value) for value in y], fontsize=7)
    panel.set_xticks([i - 0.5 for i in range(1, len(x))], minor=True)
    panel.set_yticks([i - 0.5 for i in range(1, len(y))], minor=True)
    panel.grid(which='minor', color='white', linewidth=0.6)
    panel.tick_params(which='minor', length=0)
