# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
A process of its own that tells what arrives on topics, byte for byte.

As a script: `ros_listener.py topic=type[+latched] …` writes a JSON line for every message.
As a module: `Listener` starts the script and collects its lines.
"""

from importlib import import_module
import json
import signal
import subprocess
import sys
import threading
import time
from typing import NamedTuple


class Heard(NamedTuple):
    """A message as it arrived, with the time of a steady clock in s."""

    topic: str
    time: float
    data: bytes


class Listener:
    """Subscribes in another process; `heard` grows while messages arrive."""

    def __init__(self, *topics):
        """Start listening; topics: 'name=package/msg/Type', '+latched' behind it for latched."""
        self.heard: list[Heard] = []
        self._process = subprocess.Popen(
            [sys.executable, __file__, *topics], stdout=subprocess.PIPE, text=True)
        assert self._process.stdout.readline() == 'ready\n'
        self._thread = threading.Thread(target=self._collect, daemon=True)
        self._thread.start()

    def of(self, topic):
        """Return the messages of a topic."""
        return [item for item in list(self.heard) if item.topic == topic]

    def wait(self, count, timeout=10.0):
        """Wait until so many messages have arrived and no more come; return them."""
        limit = time.monotonic() + timeout
        while len(self.heard) < count and time.monotonic() < limit:
            time.sleep(0.01)
        time.sleep(0.1)
        return list(self.heard)

    def hold(self):
        """Let the process do nothing until it is to go on."""
        self._process.send_signal(signal.SIGSTOP)

    def go_on(self):
        """Let it go on."""
        self._process.send_signal(signal.SIGCONT)

    def close(self):
        """End the process."""
        self._process.kill()
        self._process.wait()
        self._thread.join()
        self._process.stdout.close()

    def _collect(self):
        for line in self._process.stdout:
            topic, when, data = json.loads(line)
            self.heard.append(Heard(topic, when, bytes.fromhex(data)))


def main():
    """Subscribe and report until killed."""
    import rclpy
    from rclpy.node import Node
    from rclpy.qos import DurabilityPolicy, QoSProfile

    rclpy.init()
    node = Node('listener')

    def report(topic):
        return lambda data: print(
            json.dumps([topic, time.monotonic(), bytes(data).hex()]), flush=True)

    for argument in sys.argv[1:]:
        topic, _, type_name = argument.partition('=')
        qos = QoSProfile(depth=5000)
        if type_name.endswith('+latched'):
            qos = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        package, _, name = type_name.removesuffix('+latched').split('/')
        node.create_subscription(
            getattr(import_module(f'{package}.msg'), name), topic, report(topic), qos, raw=True)
    print('ready', flush=True)
    rclpy.spin(node)


if __name__ == '__main__':
    main()
