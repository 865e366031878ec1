# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Damps the swinging sphere by moving the anchor that it hangs from, and shows what that gains.

Usage, while the node runs with the default scene: python damp_sphere.py [--duration SECONDS]
It resets the run twice: the sphere swings by itself, then with the controller. The controller
knows the force of the spring only, and yields to it: a hand that gives way to what pulls it takes
energy out, one that is held still takes none.
"""

import argparse
import sys
import time

from geometry_msgs.msg import PointStamped, WrenchStamped
import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import Trigger

REST = (0.0, 0.0, 2.0)               # m: where the anchor is, and comes back to
WEIGHT = (0.0, 0.0, 9.81)            # N: what the spring pulls with when all is at rest
YIELD = 0.03                         # m/(N s): how fast the anchor gives way to a force
RETURN = 0.7                         # 1/s: how fast it comes back
REACH = 0.3                          # m: how far it may go, along each axis
# J: the energy at rest, where the spring of 100 N/m is longer than its 0.5 m by weight over
# stiffness; the centre of the sphere is 0.1 m below its end.
STRETCH = WEIGHT[2] / 100.0
ENERGY_AT_REST = WEIGHT[2] * (REST[2] - 0.5 - STRETCH - 0.1) + 50.0 * STRETCH ** 2
EARLY = 0.5                          # s: what the first forces after a reset are stamped with
TIMEOUT = 30.0                       # s


class Damper:
    """
    Moves the anchor by the force of the spring if `is_on`.

    time: of the last force of this run [s], energy: the last one heard [J]; None before the first.
    """

    def __init__(self, node):
        self.begin(False)
        self.is_heard = False
        self._hand = node.create_publisher(PointStamped, '/dynsim/hand/command', 1)
        node.create_subscription(WrenchStamped, '/dynsim/sphere/wrench/spring', self.feel, 10)
        node.create_subscription(Float64MultiArray, '/dynsim/energy', self.hear, 10)

    def begin(self, is_on):
        """Forget the last run, and be the controller of the next one or not."""
        self.is_on, self.time, self.energy = is_on, None, None
        self._position = list(REST)

    def feel(self, message):
        """Give way to the force of the spring, less the weight that it carries at rest."""
        stamp, force = message.header.stamp, message.wrench.force
        now = stamp.sec + 1e-9 * stamp.nanosec
        self.is_heard = True
        if self.time is None and now > EARLY:
            # Still of the run before the reset.
            return
        step = 0.0 if self.time is None else min(max(now - self.time, 0.0), 0.05)
        self.time = now
        if not self.is_on:
            return
        for i, pull in enumerate((force.x, force.y, force.z)):
            away = self._position[i] - REST[i]
            # What pulls the sphere up pulls the anchor down.
            away += step * (-YIELD * (pull - WEIGHT[i]) - RETURN * away)
            self._position[i] = REST[i] + min(max(away, -REACH), REACH)
        command = PointStamped()
        command.header.frame_id = 'world'
        command.point.x, command.point.y, command.point.z = self._position
        self._hand.publish(command)

    def hear(self, message):
        """Note the mechanical energy."""
        self.energy = message.data[3]


def swing(node, damper, is_on, duration):
    """Run for some simulated seconds from a reset; return the energy above rest at the end [J]."""
    reset = node.create_client(Trigger, '/dynsim/reset')
    if not reset.wait_for_service(timeout_sec=TIMEOUT):
        sys.exit('error: no node /dynsim was found; start one: make run')
    spin_until(node, lambda: damper.is_heard, TIMEOUT)
    damper.begin(False)
    rclpy.spin_until_future_complete(node, reset.call_async(Trigger.Request()))
    damper.begin(is_on)
    spin_until(node, lambda: damper.energy is not None and (damper.time or 0.0) >= duration,
               TIMEOUT + 5.0 * duration)
    return damper.energy - ENERGY_AT_REST


def spin_until(node, condition, seconds):
    """Serve what is heard until a condition holds; end the program if that takes too long."""
    limit = time.monotonic() + seconds
    while not condition():
        rclpy.spin_once(node, timeout_sec=0.1)
        if time.monotonic() > limit:
            sys.exit('error: no forces of the spring are heard: is the node paused?')


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('--duration', type=float, default=5.0,
                        help='simulated seconds of each run (default 5)')
    duration = parser.parse_args().duration
    rclpy.init()
    node = rclpy.create_node('damp_sphere')
    damper = Damper(node)
    try:
        for is_on, name in ((False, 'by itself'), (True, 'with the controller')):
            left = swing(node, damper, is_on, duration)
            print(f'{name + ":":21}{left:.3f} J above rest after {duration:g} s', flush=True)
    except (KeyboardInterrupt, ExternalShutdownException):
        print('stopped')
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
