# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Microseconds to build and publish the six messages of a tick, nobody listening, in one process.

The naive node's publish(), without stepping, beside what the ticking thread of dynsim_ros does for
ticks whose time has come, as if somebody listened: steps (RK4, as the naive node), messages,
publishing, and all that it keeps count of.
"""

import json
from pathlib import Path
import subprocess
import sys
import time

TICKS = 1000
# Simulated time runs so many times as fast, so that many ticks are late by about as much [ns]:
# by more than nothing, and by less than what would be given up.
SPEED, LATE = 1000.0, 1_000_000


def measure(rounds):
    """Return {'naive', 'ours': microseconds a tick of each round}, from another process."""
    done = subprocess.run([sys.executable, __file__, str(rounds)], check=True, text=True,
                          stdout=subprocess.PIPE)
    return json.loads(done.stdout)


class Ours:
    """Ticks of the default scene that are all due, as Bursts runs them."""

    def __init__(self, node, topics):
        sys.path.append(str(Path(__file__).resolve().parent.parent / 'test'))
        from bursting import Bursting
        from dynsim_ros.messages.scene_channels import scene_channels
        from dynsim_ros.scene import load_scene
        from dynsim_ros.simulation import Simulator

        self._simulator = Simulator(load_scene('sphere_on_spring'), rate=1000.0, integrator='rk4')
        self._simulator.advance_tick()
        channels = [channel
                    for channel in scene_channels(self._simulator.scene, self._simulator.layout)
                    if channel.topic in topics]
        assert len(channels) == len(topics)
        self._bursting = Bursting(node, self._simulator, channels, SPEED)

    def ticks(self, count):
        """Run so many ticks at least; return how many were."""
        first = self._simulator.tick
        while self._simulator.tick < first + count:
            # None are run where the machine was away meanwhile: then they are too late.
            self._bursting.go(round(LATE * SPEED))
        return self._simulator.tick - first


class Naive:
    """The naive node, and its publish()."""

    def __init__(self, node):
        self._publish = node.publish

    def ticks(self, count):
        """Publish so many ticks; return how many."""
        for _ in range(count):
            self._publish()
        return count


def main():
    import rclpy
    from naive_node import NaiveNode, TOPICS

    rclpy.init()
    nodes = NaiveNode(1000.0), rclpy.create_node('ours')
    measured = {'naive': Naive(nodes[0]), 'ours': Ours(nodes[1], TOPICS)}
    found = {name: [] for name in measured}
    for _ in range(int(sys.argv[1])):
        for name, node in measured.items():
            node.ticks(100)
            start = time.process_time()
            count = node.ticks(TICKS)
            found[name].append(1e6 * (time.process_time() - start) / count)
    print(json.dumps(found))
    for node in nodes:
        node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
