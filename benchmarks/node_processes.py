# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The processes of node.py: our node, the naive one, and what listens to them."""

from contextlib import contextmanager
import json
import os
from pathlib import Path
import signal
import subprocess
import sys
import tempfile
import time

FOLDER = Path(__file__).resolve().parent
ROOT = FOLDER.parent
WRENCH = 'geometry_msgs/msg/WrenchStamped'
# What both nodes publish, and all that is listened to.
TOPICS = {
    'sphere/pose': 'geometry_msgs/msg/PoseStamped',
    'sphere/twist': 'geometry_msgs/msg/TwistStamped',
    'sphere/wrench/spring': WRENCH, 'sphere/wrench/damper': WRENCH, 'sphere/wrench/net': WRENCH,
    'hand/pose': 'geometry_msgs/msg/PoseStamped'}
PAGE = os.sysconf('SC_PAGE_SIZE')


def keep_to_this_machine():
    """Let the processes see this machine alone, with its profile, in a domain that is free."""
    sys.path.append(str(ROOT / 'test'))
    from dds_domain import claim_domain

    domain, mark = claim_domain()
    os.environ.update(
        ROS_AUTOMATIC_DISCOVERY_RANGE='LOCALHOST', ROS_DOMAIN_ID=str(domain),
        ROS_LOG_DIR=tempfile.mkdtemp(prefix='dynsim_ros_bench_logs_'),
        FASTRTPS_DEFAULT_PROFILES_FILE=str(ROOT / 'config' / 'fastdds_one_machine.xml'),
        PYTHONPATH=os.pathsep.join([str(ROOT), *filter(None, [os.environ.get('PYTHONPATH')])]))
    return mark


class Node:
    """A node in a process of its own; kind: 'ours' or 'naive'; parameters: of ours."""

    def __init__(self, kind, rate, **parameters):
        self.name = {'ours': '/dynsim', 'naive': '/naive'}[kind]
        if kind == 'naive':
            command = [sys.executable, str(FOLDER / 'naive_node.py'), str(rate)]
        else:
            given = {'rate': float(rate), **parameters}
            command = [sys.executable, '-m', 'dynsim_ros.cli.sim_node', '-q', '--ros-args',
                       *(word for name, value in given.items()
                         for word in ('-p', f'{name.replace("__", ".")}:={shown(value)}'))]
        self._folder = tempfile.TemporaryDirectory(prefix='dynsim_ros_bench_')
        self.folder = Path(self._folder.name)
        self._process = subprocess.Popen(
            command, cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        self._proc = Path('/proc', str(self._process.pid))

    def cpu(self):
        """Return the processor time of its threads so far [s]."""
        total = 0
        for task in (self._proc / 'task').iterdir():
            try:
                total += int((task / 'schedstat').read_text().split()[0])
            except FileNotFoundError:
                continue
        return total / 1e9

    def memory(self):
        """Return the memory that it occupies [bytes]."""
        return PAGE * int((self._proc / 'statm').read_text().split()[1])

    def share(self, seconds):
        """Return the share of a core that it uses in the next seconds."""
        start, used = time.perf_counter(), self.cpu()
        time.sleep(seconds)
        return (self.cpu() - used) / (time.perf_counter() - start)

    def kill(self):
        """End it without warning."""
        self._process.kill()
        self._process.wait()

    def stop(self):
        """End it as Ctrl-C does."""
        self._process.send_signal(signal.SIGINT)
        try:
            self._process.wait(10.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


def shown(value):
    return str(value).lower() if isinstance(value, bool) else value


@contextmanager
def running(kind, rate, **parameters):
    """Give a node that runs until the block is left; what it wrote goes with it."""
    node = Node(kind, rate, **parameters)
    try:
        yield node
    finally:
        node.stop()
        node._folder.cleanup()


class Subscriber:
    """A process that listens to the topics of a node."""

    def __init__(self, node, topics=tuple(TOPICS)):
        self.node = node
        self._process = subprocess.Popen(
            [sys.executable, str(FOLDER / 'node_subscriber.py'), node.name,
             *(f'{topic}={TOPICS[topic]}' for topic in topics)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        if self._process.stdout.readline() != 'ready\n':
            raise RuntimeError(f'nothing was heard of {node.name}')

    @property
    def pid(self):
        return self._process.pid

    def begin(self, seconds, rate, commands=0):
        """Let it begin to measure."""
        asked = {'seconds': seconds, 'rate': rate, 'commands': commands}
        self._process.stdin.write(json.dumps(asked) + '\n')
        self._process.stdin.flush()

    def end(self):
        """Wait for what it has measured."""
        return json.loads(self._process.stdout.readline())

    def measure(self, seconds, rate, commands=0):
        """Return what it sees in some seconds, and the share of a core that the node uses."""
        self.begin(seconds, rate, commands)
        share = self.node.share(seconds)
        return {**self.end(), 'node cpu': share}

    def close(self):
        self._process.stdin.close()
        self._process.wait(10.0)
        self._process.stdout.close()


@contextmanager
def listening(node, topics=tuple(TOPICS)):
    """Give a Subscriber of a node until the block is left."""
    subscriber = Subscriber(node, topics)
    try:
        yield subscriber
    finally:
        subscriber.close()
