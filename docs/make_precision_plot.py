# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Draw run time against error for the main scenes, from what `make bench` last measured.

    python docs/make_precision_plot.py [--output FILE]

Needs matplotlib and Pillow. Every scene is in benchmarks/work_precision.png.
"""

import argparse
import csv
import math
from pathlib import Path

from drawing import INK, save, STYLE
from matplotlib import rc_context
from matplotlib.figure import Figure

MEASURED = Path(__file__).parent.parent / 'benchmarks' / 'work_precision.csv'
SCENES = {'S2': 'sphere in air on a spring-damper', 'S1': 'particle without losses',
          'S3q': 'stiff sphere', 'S3q8': 'stiffer sphere'}
PEERS = {'ours': ('dynsim_ros', '#2456c4'), 'numbalsoda': ('numbalsoda', '#2c8a3d'),
         'heyoka': ('heyoka', '#d9822b'), 'scipy': ('SciPy', '#7a5aa6'),
         'mujoco': ('MuJoCo', '#c9342b'), 'drake': ('Drake', '#8a6d4b'),
         'pybullet': ('PyBullet', '#8b919c')}


def main():
    parser = argparse.ArgumentParser(description='Draw run time against error.')
    parser.add_argument('--output', type=Path,
                        default=Path(__file__).with_name('work_precision.png'))
    options = parser.parse_args()
    with MEASURED.open(encoding='utf-8', newline='') as file:
        rows = list(csv.DictReader(file))
    with rc_context(STYLE):
        figure = Figure(figsize=(12, 3.6), dpi=120)
        panels = figure.subplots(1, len(SCENES), sharey=True)
        figure.subplots_adjust(left=0.065, right=0.99, top=0.79, bottom=0.15, wspace=0.08)
        for panel, (scene, title) in zip(panels, SCENES.items()):
            draw(panel, [row for row in rows if row['case'] == scene])
            panel.set_title(f'{title} ({scene})', fontsize=10)
            panel.set(xlim=(3, 1e-14), xlabel='error at the end', ylim=(2e-3, 5e3))
        panels[0].set_ylabel('run time [ms]')
        figure.legend(*panels[0].get_legend_handles_labels(), loc='upper center',
                      ncols=len(PEERS), frameon=False)
        save(figure, options.output, colours=64)


def draw(panel, rows):
    """Draw a line for each engine: the runs that no other of its runs beats in time and error."""
    for peer, (name, colour) in PEERS.items():
        points = sorted((float(row['error']), float(row['milliseconds'])) for row in rows
                        if row['peer'] == peer)
        points = [(error, time) for error, time in points
                  if 0.0 < error < 3.0 and math.isfinite(time)]
        front = [point for i, point in enumerate(points)
                 if all(point[1] < other[1] for other in points[:i])]
        is_ours = peer == 'ours'
        panel.loglog(*zip(*front), '-o', color=colour, ms=2.5, lw=2.4 if is_ours else 1.2,
                     label=name, zorder=3 if is_ours else 2)
    panel.grid(True)
    panel.tick_params(length=3, labelcolor=INK)


if __name__ == '__main__':
    main()
