# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
What a recording process that is killed loses: kill -9 again and again.

Usage: python benchmarks/bag_killed.py [KILLS] (default 100). Each process records the default
scene at 1 kHz and is killed at a random moment; the bag is recovered then. Prints how much time
lies between the last tick that was handed over and the last one that came back.
"""

import argparse
import mmap
from pathlib import Path
import random
import struct
import subprocess
import sys
import tempfile
import time

from dynsim_ros.bag.recovery.recover import recover
from dynsim_ros.bag.run_bag import RunBag
from dynsim_ros.messages.scene_channels import scene_channels
from dynsim_ros.messages.tick_rows import TickRows
from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import Simulator
import numpy as np

TICK, COMPRESSIONS = 0.001, ('zstd', 'lz4', 'none')


def record(path, last, compression):
    """Put ticks at 1 kHz until killed; the time of the last one can be read in a file."""
    simulator = Simulator(load_scene('sphere_on_spring'), rate=1.0 / TICK)
    channels = scene_channels(simulator.scene, simulator.layout)
    rows = TickRows(channels, simulator.layout)
    bag = RunBag(path, simulator, channels, rows, compression=compression)
    with open(last, 'r+b') as stream:
        told = mmap.mmap(stream.fileno(), 8)
    due = time.monotonic()
    while True:
        rows.fill(simulator.instant(), simulator.time_ns, rows.of())
        bag.put_rows(rows, simulator.time_ns, rows.of())
        told[:] = struct.pack('<q', simulator.time_ns)
        simulator.advance_tick()
        due += TICK
        time.sleep(max(due - time.monotonic(), 0.0))


def killed(path, compression, least_ns):
    """Kill a process that records, at a random moment after a time; return its last one [ns]."""
    last = path.with_suffix('.last')
    last.write_bytes(bytes(8))
    command = [sys.executable, __file__, '--record', path, last, compression]
    with subprocess.Popen(list(map(str, command))) as process:
        while struct.unpack('<q', last.read_bytes())[0] < least_ns:
            if process.poll() is not None:
                raise RuntimeError(f'the process ended with status {process.returncode}')
            time.sleep(0.01)
        time.sleep(0.1 * random.random())
        process.kill()
    return struct.unpack('<q', last.read_bytes())[0]


def losses(kills):
    """Return what so many kills cost [s]."""
    found = []
    for number in range(kills):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, 'run.mcap')
            end_ns = killed(path, COMPRESSIONS[number % len(COMPRESSIONS)], 200_000_000)
            found.append((end_ns - recover(path).last_ns) * 1e-9)
    return found


def summed_up(found):
    """Return them in one line."""
    return (f'{len(found)} processes killed: lost are {np.median(found):.3f} s (median), '
            f'{max(found):.3f} s at most')


def main():
    """Kill, and print; or be what is killed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('kills', type=int, nargs='?', default=100)
    parser.add_argument('--record', nargs=3)
    options = parser.parse_args()
    if options.record:
        record(*options.record)
    print(summed_up(losses(options.kills)))


if __name__ == '__main__':
    main()
