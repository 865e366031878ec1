# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Run time against error of the integrators, beside scipy's DOP853, in one run on one core.

Usage: python benchmarks/work_precision.py [--rounds N]; writes work_precision.md and .png beside
this file. Scenes: sphere_on_spring and particle_on_spring, 10 s. Error: the largest of the
differences of position [m], velocity [m/s], orientation (angle) [rad] and angular velocity
[rad/s] at the end, each over max(1, its size). Reference: rk4 in 80-bit arithmetic with
numpy, written here independently of the package. Time: the least over interleaved rounds.
"""

import argparse
from pathlib import Path
import time

from dynsim_ros.integrators import METHODS
from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import Simulator
import matplotlib
import numpy as np
from scipy.integrate import solve_ivp

matplotlib.use('Agg')
HERE = Path(__file__).parent
SCENES = ('sphere_on_spring', 'particle_on_spring')
DURATION = 10.0
STEPS = [1e-2 / 2 ** i for i in range(0, 12)]
TOLERANCES = [10.0 ** -e for e in range(3, 13)]


def right_hand_side(scene, real):
    """Return f(t, y) for a scene of one body on one spring, y: x, v, then q (w x y z), omega."""
    body, spring, anchor, air = scene.bodies[0], scene.springs[0], scene.anchors[0], scene.air
    vector = [np.array(a, dtype=real) for a in (anchor.position, scene.down)]
    weight = real(body.mass) * real(scene.gravity) * vector[1]
    mass, k, rest = real(body.mass), real(spring.stiffness), real(spring.natural_length)
    rigid = hasattr(body, 'radius')
    b = real(spring.damping or 0)
    drag = real(air.linear_drag if air else 0)
    whirl_drag = real(air.rotational_drag if air and rigid else 0)
    inertia = real(2) / real(5) * mass * real(body.radius) ** 2 if rigid else None
    offset = np.array([0, 0, body.radius], dtype=real) if rigid else None

    def point_f(t, y):
        x, v = y[:3], y[3:6]
        d = x - vector[0]
        length = np.sqrt(d @ d)
        u = d / length
        force = -(k * (length - rest) + b * (v @ u)) * u - drag * v + weight
        return np.concatenate([v, force / mass])

    def sphere_f(t, y):
        x, v, q, omega = y[:3], y[3:6], y[6:10], y[10:]
        w, s = q[0], q[1:]
        arm = offset + 2 * (w * np.cross(s, offset) + np.cross(s, np.cross(s, offset)))
        d = x + arm - vector[0]
        length = np.sqrt(d @ d)
        u = d / length
        rate = (v + np.cross(omega, arm)) @ u
        pull = -(k * (length - rest) + b * rate) * u
        turn = np.concatenate([[-(s @ omega)], w * omega + np.cross(omega, s)]) / 2
        return np.concatenate([v, (pull - drag * v + weight) / mass, turn,
                               (np.cross(arm, pull) - whirl_drag * omega) / inertia])

    return sphere_f if rigid else point_f


def initial(scene, real):
    """Return the initial state of a scene of one body."""
    body = scene.bodies[0]
    parts = [body.position, body.velocity]
    if hasattr(body, 'radius'):
        parts += [body.orientation, body.angular_velocity]
    return np.concatenate([np.array(part, dtype=real) for part in parts])


def reference(scene, steps):
    """Return the state at the end by extrapolated rk4 in 80-bit arithmetic."""
    real = np.longdouble
    f = right_hand_side(scene, real)

    def run(count):
        y, h = initial(scene, real), real(DURATION) / count
        for _ in range(count):
            k1 = f(0, y)
            k2 = f(0, y + h / 2 * k1)
            k3 = f(0, y + h / 2 * k2)
            y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + f(0, y + h * k3))
        return y

    coarse, fine = run(steps), run(2 * steps)
    return fine + (fine - coarse) / 15, float(np.abs(fine - coarse).max() / 15)


def error(y, expected):
    """Return the error of a state as defined above."""
    y, expected = np.asarray(y, float), np.asarray(expected, float)

    def relative(part):
        return np.abs(y[part] - expected[part]).max() / max(1, np.abs(expected[part]).max())

    errors = [relative(slice(0, 3)), relative(slice(3, 6))]
    if len(y) > 6:
        p, q = y[6:10] / np.linalg.norm(y[6:10]), expected[6:10]
        w, s = p[0] * q[0] + p[1:] @ q[1:], p[0] * q[1:] - q[0] * p[1:] + np.cross(p[1:], q[1:])
        errors += [2 * np.arctan2(np.linalg.norm(s), abs(w)), relative(slice(10, 13))]
    return max(errors)


def ours(scene, method, step):
    """Return a function that runs a scene to the end and returns the state."""
    def run():
        simulator = Simulator(scene, integrator=method, step=step)
        simulator.advance(round(DURATION * 1e9))
        return simulator.snapshot().state[:13 if hasattr(scene.bodies[0], 'radius') else 6]
    return run


def peer(scene, tolerance):
    """Return a function that runs scipy's DOP853 to the end and returns the state."""
    f, y0 = right_hand_side(scene, float), initial(scene, float)

    def run():
        return solve_ivp(f, (0, DURATION), y0, 'DOP853', rtol=tolerance, atol=tolerance,
                         t_eval=[DURATION]).y[:, -1]
    return run


def measure(scene, rounds):
    """Return {name: [(setting, error, seconds)]} and the reference's own error."""
    expected, doubt = reference(scene, 100_000)
    runs = {name: [(step, ours(scene, name, step)) for step in STEPS] for name in METHODS}
    runs['scipy DOP853'] = [(tolerance, peer(scene, tolerance)) for tolerance in TOLERANCES]
    cells = {(name, setting): [np.inf, run, None] for name, row in runs.items()
             for setting, run in row}
    for round_ in range(rounds + 1):
        for (name, _), cell in cells.items():
            if round_ > 1 and name.startswith('scipy'):
                continue
            start = time.perf_counter()
            try:
                cell[2] = cell[1]()
            except ArithmeticError:
                continue
            # The first round compiles.
            if round_:
                cell[0] = min(cell[0], time.perf_counter() - start)
    results = {}
    for (name, setting), (seconds, _, y) in cells.items():
        if y is not None and (e := error(y, expected)) < 10:
            results.setdefault(name, []).append((setting, e, seconds))
    return results, doubt


def table(all_results):
    """Return the Markdown text."""
    levels = (1e-2, 1e-3, 1e-6, 1e-9)
    lines = ['# Run time against error', '',
             'Made by `make bench` (what is measured stands at the top of work_precision.py).',
             'Milliseconds for 10 s of simulated time, the cheapest setting that '
             'reaches the error; the ratio to scipy, whose '
             'right-hand side is numpy, in brackets.', '']
    for scene, (results, doubt) in all_results.items():
        lines += [f'## {scene}', '', f'Reference known to {doubt:.1g}.', '',
                  '| method | ' + ' | '.join(f'error ≤ {level:g}' for level in levels) + ' |',
                  '|---|' + '---|' * len(levels)]
        best = {name: [min((s for _, e, s in rows if e <= level), default=None)
                       for level in levels] for name, rows in results.items()}
        for name, row in best.items():
            cells = [_cell(s, t) for s, t in zip(row, best['scipy DOP853'])]
            lines.append(f'| {name} | ' + ' | '.join(cells) + ' |')
        lines.append('')
    return '\n'.join(lines)


def _cell(seconds, scipy_seconds):
    if seconds is None:
        return '–'
    ratio = f' ({scipy_seconds / seconds:.0f}×)' if scipy_seconds else ''
    return f'{seconds * 1e3:.3g}{ratio}'


def plot(all_results, path):
    """Draw run time against error, a panel for each scene."""
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(1, len(all_results), figsize=(11, 4.6), sharey=True)
    for ax, (scene, (results, _)) in zip(axes, all_results.items()):
        for name, rows in results.items():
            ax.loglog([e for _, e, _ in rows], [1e3 * s for _, _, s in rows], 'o-', label=name,
                      markersize=3.5, linewidth=1.2)
        ax.set(title=scene, xlabel='error at 10 s')
        ax.invert_xaxis()
        ax.grid(alpha=0.3)
    axes[0].set_ylabel('run time [ms]')
    axes[0].legend(fontsize=8)
    figure.suptitle('10 s of simulated time on one core: lower and further right is better',
                    fontsize=10)
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('--rounds', type=int, default=5, help='timed rounds (default 5)')
    options = parser.parse_args()
    results = {name: measure(load_scene(name), options.rounds) for name in SCENES}
    (HERE / 'work_precision.md').write_text(table(results), encoding='utf-8')
    plot(results, HERE / 'work_precision.png')
    print(table(results))


if __name__ == '__main__':
    main()
