# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
What `kill -9` costs of the bag of a node at 1 kHz that somebody listens to.

Usage: python benchmarks/node_killed.py [KILLS] (default 20): kills so many nodes, recovers their
bags, and prints how much simulated time lacks of what was heard.
"""

import random
import sys
import time

from bag_killed import summed_up
from dynsim_ros.bag.recovery.recover import recover
from geometry_msgs.msg import PoseStamped
import node_processes
import rclpy
from rclpy.qos import QoSProfile

RATE = 1000
# The node has settled after so much simulated time; so long at most it then goes on [s].
SETTLED, MORE = 2.0, 0.3
# Longer than messages are on their way [s].
ON_THE_WAY = 0.2


class Listener:
    """Hears the poses of a node; last: the stamp of the latest one [s]."""

    def __init__(self, name):
        self.last = 0.0
        self._node = rclpy.create_node('listening')
        self._node.create_subscription(PoseStamped, f'{name}/sphere/pose', self._take,
                                       QoSProfile(depth=2 * RATE))

    def _take(self, message):
        self.last = message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec

    def listen(self, until):
        """Listen until a condition holds."""
        while not until():
            rclpy.spin_once(self._node, timeout_sec=0.01)

    def close(self):
        self._node.destroy_node()


def passes(seconds):
    """Return a condition that holds after so long."""
    end = time.monotonic() + seconds
    return lambda: time.monotonic() > end


def loss():
    """Kill a node; return how much of what was heard is not in its bag [s]."""
    with node_processes.running('ours', RATE, record__enable=True) as node:
        listener = Listener(node.name)
        listener.listen(lambda: listener.last > SETTLED)
        listener.listen(passes(MORE * random.random()))
        node.kill()
        listener.listen(passes(ON_THE_WAY))
        listener.close()
        (bag,) = node.folder.glob('runs/*.mcap')
        return listener.last - recover(bag).last_ns * 1e-9


def main():
    mark = node_processes.keep_to_this_machine()
    rclpy.init()
    print(summed_up([loss() for _ in range(int(sys.argv[1]) if len(sys.argv) > 1 else 20)]))
    rclpy.shutdown()
    mark.close()


if __name__ == '__main__':
    main()
