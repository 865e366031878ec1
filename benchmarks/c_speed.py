# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Nanoseconds a step of the simple methods on S2, beside the same formulas in plain C.

Usage: python benchmarks/c_speed.py [--rounds N] [--output FOLDER]; writes c_speed.md. steps.c is
compiled by gcc -O3 -march=native. Both run 100 000 steps of 0.1 ms, in interleaved rounds on one
core, so that calling them costs nothing beside the steps; the least time counts.
"""

import ctypes
from pathlib import Path
import shutil
import subprocess
import sys
import tempfile
import time

from cases import CASES
from dynsim_ros.simulation import Propagator
from measure import use_one_core
from metric import error
import numpy as np
from options import parse_options
from states import initial, moments_of_inertia
import tables

METHODS = ('explicit_euler', 'semi_implicit_euler', 'rk4')
STEP = 1e-4
STEPS = 100_000
FLAGS = ('-O3', '-march=native')
SOURCE = Path(__file__).with_name('steps.c')


def c_library(folder):
    """Return steps.c, compiled and loaded."""
    path = Path(folder, 'steps.so')
    subprocess.run(['gcc', *FLAGS, '-shared', '-fPIC', SOURCE, '-o', path, '-lm'], check=True)
    library = ctypes.CDLL(str(path))
    for method in METHODS:
        getattr(library, method).argtypes = (ctypes.c_void_p, ctypes.c_double, ctypes.c_long,
                                             ctypes.c_void_p)
    return library


def c_scene(scene):
    """Return the numbers of steps.c's `scene`."""
    body, spring, air = scene.bodies[0], scene.springs[0], scene.air
    weight = body.mass * scene.gravity * np.array(scene.down)
    return np.array([
        body.mass, moments_of_inertia(body)[0, 0], spring.stiffness, spring.natural_length,
        2.0 ** -64 * spring.natural_length, spring.damping, air.linear_drag, air.rotational_drag,
        *weight, *scene.anchors[0].position, *body.default_offset, *air.velocity,
        *air.angular_velocity])


def c_run(library, method, numbers, y0, steps):
    """Return a function that runs C and returns the state at the end."""
    function, address = getattr(library, method), numbers.ctypes.data

    def run():
        y = y0.copy()
        function(address, STEP, steps, y.ctypes.data)
        return y
    return run


def our_run(scene, method, size, steps):
    end_state = Propagator(scene, integrator=method, step=STEP).end_state
    return lambda: end_state(steps * STEP)[:size]


def measure(scene, library, rounds):
    """Return {method: (ns a step of C, of ours, difference of their ends)}."""
    y0, numbers = initial(scene), c_scene(scene)
    runs, times, differences = {}, {}, {}
    for method in METHODS:
        runs[method, 'C'] = c_run(library, method, numbers, y0, STEPS)
        runs[method, 'ours'] = our_run(scene, method, len(y0), STEPS)
        differences[method] = error(scene, runs[method, 'ours'](), runs[method, 'C']())
    for _ in range(rounds):
        for key, run in runs.items():
            start = time.perf_counter()
            run()
            times[key] = min(times.get(key, np.inf), time.perf_counter() - start)
    scale = 1e9 / STEPS
    return {method: (scale * times[method, 'C'], scale * times[method, 'ours'],
                     differences[method]) for method in METHODS}


def markdown(results, compiler):
    lines = ['# Speed of a step beside C', '',
             'Made by `make bench` (c_speed.py): S2, nanoseconds a step. "speed" is the time of C '
             'over that of dynsim_ros.', '', f'Machine: {tables.machine()}. {compiler}, '
             f'{" ".join(FLAGS)}; ' + ', '.join(tables.base_versions()) + '.', '',
             '| method | C | dynsim_ros | speed | difference of the ends |',
             '|---|---|---|---|---|']
    lines += [f'| {method} | {c:.1f} | {ours:.1f} | {c / ours:.2f} | {difference:.1g} |'
              for method, (c, ours, difference) in results.items()]
    return '\n'.join(lines) + '\n'


def main():
    options = parse_options(__doc__, 'c_speed.md', 30)
    if shutil.which('gcc') is None:
        return 'error: gcc was not found, which compiles steps.c; install it (apt install gcc)'
    compiler = subprocess.run(['gcc', '--version'], capture_output=True, text=True,
                              check=True).stdout.splitlines()[0]
    use_one_core()
    with tempfile.TemporaryDirectory() as folder:
        results = measure(CASES['S2'].scene, c_library(folder), options.rounds)
    text = markdown(results, compiler)
    (options.output / 'c_speed.md').write_text(text, encoding='utf-8')
    print(text)
    return 0


if __name__ == '__main__':
    sys.exit(main())
