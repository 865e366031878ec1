# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Ten thousand seconds of S2 without losses: how far the energy drifts."""

import time

from cases import CASES
from dynsim_ros.simulation import Propagator
import numpy as np
from stability_cells import energy
from states import initial, Places

DURATION, STEP, TOLERANCE = 1e4, 1e-3, 1e-12
# When auto is looked at [s]; the methods of fixed step are at every second.
TIMES = (1.0, 1e1, 1e2, 1e3, 3e3, 1e4)
BUDGET = 100_000_000
FIXED_STEP = ('leapfrog', 'semi_implicit_euler')


def drifts():
    """Return rows (method, {time [s]: relative change of energy}, largest, seconds)."""
    scene = CASES['S2-lossless'].scene
    size, y0 = Places(scene).size, initial(scene)
    start, whole = energy(scene, y0), stored(scene, y0)

    def change(y):
        return (energy(scene, y[:size]) - start) / whole

    rows = []
    auto = Propagator(scene, integrator='auto', tolerance=TOLERANCE, budget=BUDGET)
    # Compiled before the time is taken.
    auto.end_state(TIMES[0])
    began = time.perf_counter()
    found = {t: change(auto.end_state(t)) for t in TIMES}
    rows.append((f'auto, tolerance {TOLERANCE:g}', found, max(map(abs, found.values())),
                 time.perf_counter() - began))
    for name in FIXED_STEP:
        propagator = Propagator(scene, integrator=name, step=STEP)
        propagator.end_state(TIMES[0])
        began = time.perf_counter()
        changes = np.array([change(y) for y in propagator.samples(DURATION, 1.0)])
        rows.append((f'{name.replace("_", " ")}, step {STEP * 1e3:g} ms',
                     {t: changes[round(t)] for t in TIMES}, np.abs(changes).max(),
                     time.perf_counter() - began))
    return rows


def stored(scene, y):
    """Return the energy without that of gravity [J]."""
    places, body = Places(scene), scene.bodies[0]
    height = -y[places.position(0)] @ np.array(scene.down)
    return energy(scene, y) - body.mass * scene.gravity * height


def markdown(rows):
    """Return the lines of the table."""
    lines = ['## Long runs', '',
             f'S2-lossless for {DURATION:g} s: change of the energy, over what motion and spring '
             'have of it at the start. The largest is of these instants for auto, of all whole '
             'seconds for the others. Seconds: what all of it took to compute.', '',
             '| method | ' + ' | '.join(f'{t:g} s' for t in TIMES) + ' | largest | seconds |',
             '|---|' + '---|' * (len(TIMES) + 2)]
    lines += [f'| {name} | ' + ' | '.join(f'{changes[t]:.1e}' for t in TIMES)
              + f' | {largest:.1e} | {seconds:.1f} |' for name, changes, largest, seconds in rows]
    return [*lines, '']
