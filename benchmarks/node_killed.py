# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
What `kill -9` costs of the bag of a node at 1 kHz, while somebody listens and while nobody does.

Usage: python benchmarks/node_killed.py [KILLS] (default 20): kills so many nodes each, recovers
their bags, and prints how much simulated time lacks of what was heard, or would have been.
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
    """
    Hears the poses of a node.

    last: the stamp of the latest one [s]; begin: the steady clock at simulated time 0 [s], by the
    quickest message.
    """

    def __init__(self, name):
        self.last, self.begin = 0.0, float('inf')
        self._node = rclpy.create_node('listening')
        self._poses = self._node.create_subscription(
            PoseStamped, f'{name}/sphere/pose', self._take, QoSProfile(depth=2 * RATE))

    def _take(self, message):
        self.last = message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec
        self.begin = min(self.begin, time.monotonic() - self.last)

    def leave(self):
        """Hear no more."""
        self._node.destroy_subscription(self._poses)

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


def loss(is_heard):
    """Kill a node; return how much of what was or would have been heard lacks in its bag [s]."""
    with node_processes.running('ours', RATE, record__enable=True) as node:
        listener = Listener(node.name)
        listener.listen(lambda: listener.last > SETTLED)
        if not is_heard:
            listener.leave()
            listener.listen(passes(SETTLED))
        listener.listen(passes(MORE * random.random()))
        killed = time.monotonic() - listener.begin
        node.kill()
        listener.listen(passes(ON_THE_WAY))
        listener.close()
        (bag,) = node.folder.glob('runs/*.mcap')
        return (listener.last if is_heard else killed) - recover(bag).last_ns * 1e-9


def main():
    mark = node_processes.keep_to_this_machine()
    rclpy.init()
    kills = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    for is_heard, audience in ((True, 'somebody listens'), (False, 'nobody listens')):
        print(f'{audience}: {summed_up([loss(is_heard) for _ in range(kills)])}')
    rclpy.shutdown()
    mark.close()


if __name__ == '__main__':
    main()
