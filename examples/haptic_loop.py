# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
A haptic loop over two processes: the hand's position goes out, the spring's force comes back.

Usage: python haptic_loop.py [--duration SECONDS]. It starts sim_node at 1 kHz with the default
scene, and is the hand itself: a mass that a person moves to and fro and that feels the spring.
With each wrench that arrives the hand moves on by what time has passed, and says where it is. The
round trip is the time from a position sent to the arrival of the first wrench that knows of it.
"""

import argparse
import math
import signal
import statistics
import subprocess
import sys
import time

from geometry_msgs.msg import PointStamped, PoseStamped, WrenchStamped
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions
try:
    from rclpy.experimental.events_executor import EventsExecutor as Executor
except ImportError:
    Executor = SingleThreadedExecutor

RATE = 1000.0                        # Hz
MASS, DAMPING = 0.5, 2.0             # kg, N s/m: the hand
REST, GRIP = (0.0, 0.0, 2.0), 200.0  # m, N/m: where the person holds it, and how firmly
REACH, PERIOD = 0.1, 2.0             # m, s: how far it is moved along x, and how often


class Hand:
    """Moves by the forces of the person and of the spring; trips: round trips [s]."""

    def __init__(self, node):
        self.position, self.velocity = list(REST), [0.0, 0.0, 0.0]
        self.force = (0.0, 0.0, 0.0)
        self.trips, self.furthest, self.strongest = [], 0.0, 0.0
        self._sent, self._arrived = {}, {}
        self._begin = self._last = time.perf_counter()
        self._publisher = node.create_publisher(PointStamped, '/dynsim/hand/command', 1)
        node.create_subscription(
            WrenchStamped, '/dynsim/sphere/wrench/spring', self.feel, 10)
        node.create_subscription(PoseStamped, '/dynsim/hand/pose', self.seen, 10)

    def feel(self, message):
        """Take the spring's force, move on, and say where the hand is now."""
        force = message.wrench.force
        # What pulls the sphere pulls the hand the other way.
        self.force = (-force.x, -force.y, -force.z)
        self.strongest = max(self.strongest, math.hypot(*self.force))
        now = time.perf_counter()
        self._arrived[key(message.header.stamp)] = now
        self._move(now, min(now - self._last, 0.01))
        self._last = now
        command = PointStamped()
        command.header.frame_id = 'world'
        command.point.x, command.point.y, command.point.z = self.position
        self._sent[tuple(self.position)] = time.perf_counter()
        self._publisher.publish(command)

    def _move(self, now, step):
        """Advance the hand by some seconds, semi-implicitly."""
        wanted = REACH * math.sin(2.0 * math.pi * (now - self._begin) / PERIOD)
        goal = (REST[0] + wanted, REST[1], REST[2])
        for axis in range(3):
            force = (self.force[axis] + GRIP * (goal[axis] - self.position[axis])
                     - DAMPING * self.velocity[axis])
            self.velocity[axis] += step * force / MASS
            self.position[axis] += step * self.velocity[axis]
        self.furthest = max(self.furthest, abs(self.position[0] - REST[0]))

    def seen(self, message):
        """Note the round trip of a position that the simulation has taken over."""
        position = message.pose.position
        sent = self._sent.pop((position.x, position.y, position.z), None)
        arrived = self._arrived.get(key(message.header.stamp))
        if sent is not None and arrived is not None:
            self.trips.append(arrived - sent)
        if len(self._arrived) > 100:
            self._arrived.clear()
            self._sent.clear()


def key(stamp):
    return stamp.sec, stamp.nanosec


def close_loop(duration, simulation):
    """Be the hand for some seconds after the simulation is found, or until it ends; return it."""
    node = rclpy.create_node('hand')
    hand = Hand(node)
    executor = Executor()
    executor.add_node(node)
    end = math.inf
    while (now := time.perf_counter()) < end and simulation.poll() is None:
        executor.spin_once(timeout_sec=0.1)
        if end == math.inf and hand.trips:
            # Found; what happened until both sides knew of each other does not count.
            end = now + duration
            hand.trips.clear()
    executor.shutdown()
    node.destroy_node()
    return hand


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('--duration', type=float, default=10.0, help='seconds (default 10)')
    duration = parser.parse_args().duration
    simulation = subprocess.Popen([sys.executable, '-m', 'dynsim_ros.cli.sim_node', '-q',
                                   '--ros-args', '-p', f'rate:={RATE}'])
    # Ctrl-C ends the simulation, and with it the loop.
    stopped = []
    signal.signal(signal.SIGINT, lambda *_: stopped.append(simulation.send_signal(signal.SIGINT)))
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    try:
        hand = close_loop(duration, simulation)
    finally:
        simulation.send_signal(signal.SIGINT)
        simulation.wait()
        rclpy.try_shutdown()
    if stopped:
        return
    if len(hand.trips) < 2:
        sys.exit('error: no round trip: the simulation ended, or nothing was heard of it')
    trips = statistics.quantiles(hand.trips, n=100)
    print(f'{len(hand.trips)} round trips in {duration:g} s: p50 {1e3 * trips[49]:.2f} ms, '
          f'p99 {1e3 * trips[98]:.2f} ms; the hand moved by {hand.furthest:.3f} m and felt up to '
          f'{hand.strongest:.1f} N')


if __name__ == '__main__':
    main()
