# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Which damping brings the sphere to rest soonest? A sweep over two parameters, without ROS.

Usage: python sweep.py [--processes N]. For every stiffness and damping the motion is computed for
half a minute, in a pool of processes; what is compared is how far the sphere still swings at the
end. A spring-damper acts along the spring only: what swings sideways, the air has to stop.
"""

import argparse
from concurrent.futures import ProcessPoolExecutor
from itertools import product
from multiprocessing import get_context
import os

from dynsim_ros.scene import load_scene, with_values
from dynsim_ros.simulation import Propagator
from dynsim_ros.simulation.layout import Layout
import numpy as np

STIFFNESS = (25.0, 50.0, 100.0, 200.0)          # N/m
DAMPING = (0.1, 0.5, 2.0, 5.0, 10.0, 20.0)      # N s/m
DURATION, LAST, RATE = 30.0, 5.0, 100.0         # s, s, Hz


def swing(stiffness, damping):
    """Return how far up and down the sphere goes in the last seconds [m]."""
    scene = with_values(load_scene('sphere_on_spring'), {
        'spring.stiffness': stiffness, 'spring.damping': damping})
    states = Propagator(scene, tolerance=1e-8).samples(DURATION, RATE)
    height = states[-round(LAST * RATE):, Layout(scene).position('sphere')][:, 2]
    return float(np.ptp(height))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('--processes', type=int, default=os.cpu_count())
    processes = parser.parse_args().processes
    pairs = list(product(STIFFNESS, DAMPING))
    swing(*pairs[0])        # compiles what all need, if need be, so that only one has to
    with ProcessPoolExecutor(processes, mp_context=get_context('spawn')) as pool:
        found = np.array(list(pool.map(swing, *zip(*pairs)))).reshape(len(STIFFNESS), -1)
    print(f'height [mm] that the sphere covers from {DURATION - LAST:g} to {DURATION:g} s')
    print(f'{"":>12}' + ''.join(f'{damping:>10g}' for damping in DAMPING) + '  N s/m')
    for stiffness, row in zip(STIFFNESS, found):
        print(f'{stiffness:>8g} N/m' + ''.join(f'{1e3 * height:>10.3g}' for height in row))
    best = np.unravel_index(found.argmin(), found.shape)
    print(f'least: {STIFFNESS[best[0]]:g} N/m, {DAMPING[best[1]]:g} N s/m')


if __name__ == '__main__':
    main()
