# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The default scene as a node in the way that tutorials of rclpy show: what node.py compares with.

One timer, SingleThreadedExecutor, a new message for each topic and tick, RK4 in plain Python with
one step a tick. Usage: python benchmarks/naive_node.py [RATE]; the node is called /naive and has
the topics of /dynsim that are in TOPICS.
"""

import math
import sys

from geometry_msgs.msg import (Point, PointStamped, Pose, PoseStamped, Quaternion, Twist,
                               TwistStamped, Vector3, Wrench, WrenchStamped)
import rclpy
from rclpy.node import Node
from std_msgs.msg import Header

TOPICS = {
    'sphere/pose': PoseStamped, 'sphere/twist': TwistStamped,
    'sphere/wrench/spring': WrenchStamped, 'sphere/wrench/damper': WrenchStamped,
    'sphere/wrench/net': WrenchStamped, 'hand/pose': PoseStamped}

MASS, RADIUS, GRAVITY = 1.0, 0.1, 9.81               # kg, m, m/s^2
INERTIA = 0.4 * MASS * RADIUS ** 2                   # kg m^2
STIFFNESS, DAMPING, NATURAL_LENGTH = 100.0, 0.5, 0.5  # N/m, N s/m, m
LINEAR_DRAG, ROTATIONAL_DRAG = 0.1, 0.001            # N s/m, N m s/rad


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def wrenches(y, hand):
    """Return (force, torque) of spring, damper and all; y: x, v, q (w, x, y, z), omega."""
    x, v, (w, i, j, k), omega = y[0:3], y[3:6], y[6:10], y[10:13]
    arm = (RADIUS * 2 * (i * k + w * j), RADIUS * 2 * (j * k - w * i),
           RADIUS * (1 - 2 * (i * i + j * j)))
    spin = cross(omega, arm)
    line = tuple(x[n] + arm[n] - hand[n] for n in range(3))
    length = math.sqrt(sum(part * part for part in line))
    u = tuple(part / length for part in line)
    pull = -STIFFNESS * (length - NATURAL_LENGTH)
    brake = -DAMPING * sum((v[n] + spin[n]) * u[n] for n in range(3))
    spring, damper = tuple(pull * part for part in u), tuple(brake * part for part in u)
    net = tuple(spring[n] + damper[n] - LINEAR_DRAG * v[n] for n in range(3))
    net = (net[0], net[1], net[2] - MASS * GRAVITY)
    turn_spring, turn_damper = cross(arm, spring), cross(arm, damper)
    turn = tuple(turn_spring[n] + turn_damper[n] - ROTATIONAL_DRAG * omega[n] for n in range(3))
    return (spring, turn_spring), (damper, turn_damper), (net, turn)


def derivative(y, hand):
    _, _, (force, torque) = wrenches(y, hand)
    (w, i, j, k), (a, b, c) = y[6:10], y[10:13]
    return (*y[3:6], *(part / MASS for part in force),
            0.5 * (-a * i - b * j - c * k), 0.5 * (a * w + b * k - c * j),
            0.5 * (b * w + c * i - a * k), 0.5 * (c * w + a * j - b * i),
            *(part / INERTIA for part in torque))


def rk4(y, h, hand):
    """Return the state after h [s]."""
    k1 = derivative(y, hand)
    k2 = derivative([a + 0.5 * h * b for a, b in zip(y, k1)], hand)
    k3 = derivative([a + 0.5 * h * b for a, b in zip(y, k2)], hand)
    k4 = derivative([a + h * b for a, b in zip(y, k3)], hand)
    y = [a + h / 6 * (b + 2 * c + 2 * d + e) for a, b, c, d, e in zip(y, k1, k2, k3, k4)]
    size = math.sqrt(sum(part * part for part in y[6:10]))
    return [*y[:6], *(part / size for part in y[6:10]), *y[10:]]


class NaiveNode(Node):
    """Steps and publishes in a timer's callback."""

    def __init__(self, rate):
        super().__init__('naive')
        self.step = 1.0 / rate
        self.hand = (0.0, 0.0, 2.0)
        self.state = [0.3, 0.0, 1.2, 0.0, 0.5, 0.0, math.cos(0.15), math.sin(0.15), 0.0, 0.0,
                      1.0, 2.0, 3.0]
        self.named = {name: self.create_publisher(kind, f'~/{name}', 10)
                      for name, kind in TOPICS.items()}
        self.create_subscription(PointStamped, '~/hand/command', self.move, 10)
        self.create_timer(self.step, self.tick)

    def move(self, message):
        self.hand = (message.point.x, message.point.y, message.point.z)

    def tick(self):
        self.state = rk4(self.state, self.step, self.hand)
        self.publish()

    def publish(self):
        """Publish the state as new messages."""
        x, v, (w, i, j, k), omega = (self.state[:3], self.state[3:6], self.state[6:10],
                                     self.state[10:])
        spring, damper, net = wrenches(self.state, self.hand)
        header = Header(stamp=self.get_clock().now().to_msg(), frame_id='world')
        self.named['sphere/pose'].publish(PoseStamped(header=header, pose=Pose(
            position=Point(x=x[0], y=x[1], z=x[2]),
            orientation=Quaternion(w=w, x=i, y=j, z=k))))
        self.named['sphere/twist'].publish(TwistStamped(header=header, twist=Twist(
            linear=vector(v), angular=vector(omega))))
        for name, (force, torque) in (('spring', spring), ('damper', damper), ('net', net)):
            self.named[f'sphere/wrench/{name}'].publish(WrenchStamped(
                header=header, wrench=Wrench(force=vector(force), torque=vector(torque))))
        self.named['hand/pose'].publish(PoseStamped(header=header, pose=Pose(
            position=Point(x=self.hand[0], y=self.hand[1], z=self.hand[2]))))


def vector(parts):
    return Vector3(x=parts[0], y=parts[1], z=parts[2])


def main():
    rclpy.init()
    node = NaiveNode(float(sys.argv[1]) if len(sys.argv) > 1 else 1000.0)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
