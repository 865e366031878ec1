# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Microseconds to build and publish the six messages of a tick, nobody listening, in one process.

The naive node's publish() beside the topics of dynsim_ros, as if somebody listened; without
stepping.
"""

import json
from pathlib import Path
import subprocess
import sys
import time

TICKS = 1000


def measure(rounds):
    """Return {'naive', 'ours': microseconds a tick of each round}, from another process."""
    done = subprocess.run([sys.executable, __file__, str(rounds)], check=True, text=True,
                          stdout=subprocess.PIPE)
    return json.loads(done.stdout)


def ours(node, topics):
    """Return a function that builds and publishes a tick of the default scene."""
    sys.path.append(str(Path(__file__).resolve().parent.parent / 'test'))
    from all_listen import AllListen
    from dynsim_ros.messages.scene_channels import scene_channels
    from dynsim_ros.messages.tick_rows import TickRows
    from dynsim_ros.ros.own_parameters import OWN
    from dynsim_ros.ros.topics import Topics
    from dynsim_ros.scene import load_scene
    from dynsim_ros.simulation import Simulator

    simulator = Simulator(load_scene('sphere_on_spring'), rate=1000.0)
    simulator.advance_tick()
    channels = [channel for channel in scene_channels(simulator.scene, simulator.layout)
                if channel.topic in topics]
    assert len(channels) == len(topics)
    published = Topics(node, channels, TickRows(channels, simulator.layout), AllListen(),
                       {name: own.default for name, own in OWN.items()})
    return lambda: published.publish(simulator, 123_456_789, recording=False)


def main():
    import rclpy
    from naive_node import NaiveNode, TOPICS

    rclpy.init()
    nodes = NaiveNode(1000.0), rclpy.create_node('ours')
    ticks = {'naive': nodes[0].publish, 'ours': ours(nodes[1], TOPICS)}
    found = {name: [] for name in ticks}
    for _ in range(int(sys.argv[1])):
        for name, tick in ticks.items():
            tick()
            start = time.process_time()
            for _ in range(TICKS):
                tick()
            found[name].append(1e6 * (time.process_time() - start) / TICKS)
    print(json.dumps(found))
    for node in nodes:
        node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
