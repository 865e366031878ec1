# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Command the default scene at random for a while: arguments are a seed and how long [s].

A process of its own: anchors move, bodies are pushed, parameters are set, topics are listened to.
"""

import random
import sys
import time

from geometry_msgs.msg import PointStamped, WrenchStamped
from ros_client import Client
from scene_topics import POSE


def main(seed, seconds):
    """Command until the time is over; print how many commands were accepted."""
    choose, count = random.Random(seed), 0
    client = Client()
    client.listen({'sphere/pose': POSE})
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        kind = choose.randrange(4)
        if kind == 0:
            point = PointStamped()
            point.point.x, point.point.z = choose.uniform(-0.3, 0.3), choose.uniform(1.9, 2.1)
            client.publish('hand/command', point)
        elif kind == 1:
            wrench = WrenchStamped()
            wrench.wrench.force.y = choose.gauss(0.0, 2.0)
            wrench.wrench.torque.x = choose.gauss(0.0, 0.01)
            client.publish('sphere/wrench_command', wrench)
        else:
            values = {'spring.stiffness': choose.uniform(50.0, 200.0),
                      'gravity': choose.uniform(5.0, 10.0),
                      'publish_rate.state': choose.choice([0.0, 50.0, 20.0]),
                      'anchor_interpolation': choose.choice(['hold', 'linear']),
                      'wrench_timeout': choose.uniform(0.01, 0.5),
                      'real_time_factor': choose.choice([1.0, 2.0])}
            group = {name: values[name] for name in choose.sample([*values], kind)}
            assert client.set_group(group).successful, group
        count += 1
        # now and then several between two ticks
        if choose.random() < 0.7:
            before, limit = len(client.heard['sphere/pose']), time.monotonic() + 0.2
            client.wait(lambda before=before, limit=limit: time.monotonic() > limit
                        or len(client.heard['sphere/pose']) > before)
    print(count)
    client.close()


if __name__ == '__main__':
    main(int(sys.argv[1]), float(sys.argv[2]))
