# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
What a scene lacks is not computed: the cost of a step with each term removed in turn.

Usage: python benchmarks/skipping.py [--rounds N] [--output FOLDER]; writes skipping.md, .csv and
.png. The full scene is a body on a spring-damper at a moving anchor, in air, the works counted.
Times are the least of interleaved rounds on one core; compiling comes before (minutes at first,
afterwards it is cached).
"""

import csv
from dataclasses import replace
import sys
import time

from cases import CASES
from dynsim_ros.integrators import new_steps
from dynsim_ros.physics.drive import undisturbed_drive
from dynsim_ros.physics.model import build_model
from dynsim_ros.physics.state import initial_state
from dynsim_ros.scene import Air, Anchor, Box, Particle
from dynsim_ros.simulation.settings import SECOND, Settings
from measure import use_one_core
import numpy as np
from options import parse_options
import tables

STEP, TOLERANCE = 1e-3, 1e-9
# Simulated time of a run [s].
DURATIONS = {'rk4': 5.0, 'extrapolation': 50.0}
STAGES = 4
BODIES = ('sphere', 'box')
HEAD = """\
# What a scene lacks is not computed

Made by `make bench-skipping` (skipping.py): a body on a spring-damper at a moving anchor, in air,
the works of damper, air and anchor counted ("full"), then with each term removed in turn and at
last with several of them removed. Nanoseconds of a step on one core: over 5 s by rk4, over 50 s by
extrapolation, where a call costs as much as a few steps, and the scene without a spring has hardly
more. Evaluations of the right-hand side are per simulated second: by rk4 at 1 ms, and by
extrapolation at tolerance 1e-9, whose steps are as long as the motion allows, so that a motion
that nothing damps needs more of them; what it evaluates side by side in SIMD lanes counts once.
The box has an inertia that is not the same about every axis. The percentages are of "full".
"""


def variants(kind):
    """Return {what was removed: (Scene, works are counted)}."""
    full = full_scene(kind)
    body, spring, still = full.bodies[0], full.springs[0], resting(full)
    drag, whirl = full.air.linear_drag, full.air.rotational_drag
    point = Particle(name=body.name, mass=body.mass, position=body.position,
                     velocity=body.velocity)
    changed = {
        'full': full,
        'damper': replace(full, springs=[replace(spring, damping=None)]),
        'linear drag': replace(full, air=Air(rotational_drag=whirl)),
        'rotational drag': replace(full, air=Air(linear_drag=drag)),
        'gravity': replace(full, gravity=None),
        'spring': replace(full, springs=[]),
        'orientation (a particle)': replace(full, bodies=[point], air=Air(linear_drag=drag)),
        'works': full,
        'movement of the anchor': still,
        'all but body and spring': replace(
            still, springs=[replace(spring, damping=None)], air=None, gravity=None),
        'all but particle and spring': replace(
            still, springs=[replace(spring, damping=None)], air=None, gravity=None,
            bodies=[point])}
    return {name: (scene, name != 'works' and not name.startswith('all but'))
            for name, scene in changed.items()}


def full_scene(kind):
    """Return the scene of S2-moving, its body a sphere or a box."""
    scene = CASES['S2-moving'].scene
    if kind == 'sphere':
        return scene
    body = scene.bodies[0]
    box = Box(name='box', mass=body.mass, size=(0.1, 0.2, 0.3), position=body.position,
              velocity=body.velocity, orientation=body.orientation,
              angular_velocity=body.angular_velocity)
    return replace(scene, bodies=[box], springs=[replace(scene.springs[0], to='box')])


def resting(scene):
    return replace(scene, anchors=[Anchor(name=anchor.name, position=anchor.position)
                                   for anchor in scene.anchors])


class Run:
    """A scene with a method, ready to run; counts: of the last run."""

    def __init__(self, scene, works, method):
        model = build_model(scene)
        self.method, self.seconds = method, np.inf
        self._start = initial_state(scene, model)
        settings = Settings(integrator=method, step=STEP, tolerance=TOLERANCE)
        self._steps = new_steps(settings, model, undisturbed_drive(scene, works or None),
                                len(self._start))
        self.run()
        self.seconds = np.inf

    def run(self):
        """Run once from the start, and keep the time if it is the least."""
        self._steps.reset()
        self._steps.begin(0, self._start)
        start = time.perf_counter()
        self._steps.end_at(round(DURATIONS[self.method] * SECOND))
        self.seconds = min(self.seconds, time.perf_counter() - start)

    @property
    def counts(self):
        """Return (steps, evaluations)."""
        if self.method == 'rk4':
            return self._steps.steps, STAGES * self._steps.steps
        steps, rejected, evaluations, *_ = map(int, self._steps.counts)
        return steps + rejected, evaluations


def measure(rounds):
    """Return rows (body, removed, method, ns a step, evaluations per simulated second)."""
    runs = {(kind, name, method): Run(scene, works, method) for kind in BODIES
            for name, (scene, works) in variants(kind).items()
            for method in DURATIONS}
    for _ in range(rounds):
        for run in runs.values():
            run.run()
    return [(*key, 1e9 * run.seconds / run.counts[0], run.counts[1] / DURATIONS[key[2]])
            for key, run in runs.items()]


def markdown(rows):
    lines = [HEAD, f'Machine: {tables.machine()}. ' + ', '.join(tables.base_versions()) + '.']
    for kind in BODIES:
        found = {(name, method): cell for body, name, method, *cell in rows if body == kind}
        lines += ['', f'## {kind.capitalize()}', '',
                  '| removed | rk4, ns a step | extrapolation, ns a step | rk4, evaluations/s '
                  '| extrapolation, evaluations/s |', '|---|---|---|---|---|']
        for name in dict.fromkeys(name for name, _ in found):
            (rk4, rk4_work), (own, own_work) = found[name, 'rk4'], found[name, 'extrapolation']
            full_rk4, full = found['full', 'rk4'][0], found['full', 'extrapolation'][0]
            lines.append(f'| {"– (full)" if name == "full" else name} '
                         f'| {rk4:.0f} ({rk4 / full_rk4:.0%}) | {own:.0f} ({own / full:.0%}) '
                         f'| {rk4_work:.0f} | {own_work:.0f} |')
    return '\n'.join(lines) + '\n'


def plot(rows, path):
    """Draw the time of a step as bars, a panel for each body and method."""
    import matplotlib
    matplotlib.use('Agg')
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(2, 2, figsize=(12, 7), sharey=True)
    for row, kind in enumerate(BODIES):
        for column, method in enumerate(DURATIONS):
            bars = [(name, ns) for body, name, how, ns, _ in rows
                    if (body, how) == (kind, method)]
            ax = axes[row, column]
            drawn = ax.barh(*zip(*bars), color=['#0072B2'] + ['#56B4E9'] * (len(bars) - 1))
            ax.bar_label(drawn, fmt='%.0f', padding=3, fontsize=8)
            ax.axvline(bars[0][1], color='0.5', linewidth=0.8, linestyle='--')
            ax.set(title=f'{kind}, {method}', xlabel='ns a step',
                   xlim=(0, 1.15 * max(ns for _, ns in bars)))
    axes[0, 0].invert_yaxis()
    figure.supylabel('removed')
    figure.tight_layout()
    figure.savefig(path, dpi=90)


def main():
    options = parse_options(__doc__, 'the results', 50)
    use_one_core()
    rows = measure(options.rounds)
    text = markdown(rows)
    (options.output / 'skipping.md').write_text(text, encoding='utf-8')
    with (options.output / 'skipping.csv').open('w', encoding='utf-8', newline='') as file:
        writer = csv.writer(file, lineterminator='\n')
        writer.writerow(['body', 'removed', 'method', 'ns a step', 'evaluations per second'])
        writer.writerows((*names, f'{ns:.1f}', f'{work:.1f}') for *names, ns, work in rows)
    plot(rows, options.output / 'skipping.png')
    print(text)


if __name__ == '__main__':
    sys.exit(main())
