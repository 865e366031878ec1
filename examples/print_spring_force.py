# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Prints the force of the spring on the sphere, ten times a second of simulated time.

Usage, while the node runs: python print_spring_force.py [--count LINES]
"""

import argparse
import math
import signal

from geometry_msgs.msg import WrenchStamped
import rclpy
from rclpy.signals import SignalHandlerOptions

TOPIC = '/dynsim/sphere/wrench/spring'
PERIOD = 0.1                         # s


class Printer:
    """Prints a message whenever a period has passed; count: lines left to print."""

    def __init__(self, count):
        self.count = count
        self._next = -math.inf

    def take(self, message):
        """Print the force if it is time; stamps begin at 0 again after a reset."""
        stamp, force = message.header.stamp, message.wrench.force
        time = stamp.sec + 1e-9 * stamp.nanosec
        if self.count > 0 and not self._next - PERIOD <= time < self._next:
            self._next = time + PERIOD - 1e-9
            self.count -= 1
            print(f'{time:8.2f} s  {force.x:+8.3f} {force.y:+8.3f} {force.z:+8.3f} N  '
                  f'|F| {math.hypot(force.x, force.y, force.z):7.3f} N', flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('--count', type=int, default=10 ** 9, help='stop after so many lines')
    printer = Printer(parser.parse_args().count)
    # Ctrl-C is to end the loop below, not what rclpy is just doing.
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    signal.signal(signal.SIGINT, lambda *_: setattr(printer, 'count', 0))
    node = rclpy.create_node('spring_force')
    node.create_subscription(WrenchStamped, TOPIC, printer.take, 10)
    while printer.count > 0:
        rclpy.spin_once(node, timeout_sec=0.1)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
