# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
States of a run as the node computes them, by the kernels that it uses.

Scenes that have the same kinds of parts as sphere_on_spring need no kernels of their own, so that
each method is compiled once for all tests of such scenes.
"""

from dynsim_ros.simulation import Simulator
import numpy as np


def samples(scene, duration, rate, **settings):
    """Return ((n, size) states at each tick up to a duration [s], {'steps', 'rejected'})."""
    simulator = Simulator(scene, rate=rate, **settings)
    states = [simulator.snapshot().state]
    for _ in range(round(duration * 1e9) // simulator.settings.tick_ns):
        simulator.advance_tick()
        states.append(simulator.snapshot().state)
    return np.array(states), dict(zip(('steps', 'rejected'), simulator.counts))
