# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
A process that listens to a node, sends it commands, and tells what it saw; it costs little itself.

Usage: node_subscriber.py NODE TOPIC=TYPE ...; says "ready" when something has come on each topic.
Then, for each line of JSON {"seconds", "rate", "commands": a second} it answers with one line.

Fast DDS receives, times and counts in a thread of its own; what came is taken out of its queue
every few milliseconds. When a message was sent (source_timestamp) and its number among all that
the publisher wrote come from there, so they say what the node did, however late this process is.
"""

from importlib import import_module
import json
import random
import resource
import struct
import sys
import time

from geometry_msgs.msg import PointStamped
import numpy as np
import rclpy
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message

# Longer than what comes between two looks at the fullest rate.
DEPTH = 5000
LOOK = 0.005
# So late may a tick be made up for [s]: what lacks of it at the end was not missed.
MADE_UP = 0.02
# A machine holds up what runs on it now and then, but not in most stretches of this length [s].
STRETCH = 0.1
HAND, PROBE = 'hand/pose', 'sphere/pose'


def main():
    rclpy.init()
    node = rclpy.create_node('measuring', start_parameter_services=False, enable_rosout=False)
    target, *topics = sys.argv[1:]
    ears = [Ear(node, target, *topic.split('=')) for topic in topics]
    publisher = node.create_publisher(PointStamped, f'{target}/hand/command', 10)
    while not all(ear.numbers for ear in ears) or not publisher.get_subscription_count():
        time.sleep(LOOK)
        for ear in ears:
            ear.take()
    print('ready', flush=True)
    for line in sys.stdin:
        print(json.dumps(measure(ears, publisher, **json.loads(line))), flush=True)
    node.destroy_node()
    rclpy.shutdown()


class Ear:
    """A subscription: numbers, send and arrival times [ns], stamps [ns], bytes of what came."""

    def __init__(self, node, target, topic, kind):
        package, folder, name = kind.split('/')
        self.topic = topic
        self.kind = getattr(import_module(f'{package}.{folder}'), name)
        self._subscription = node.create_subscription(
            self.kind, f'{target}/{topic}', lambda message: None, QoSProfile(depth=DEPTH))
        self._handle = self._subscription.handle
        self.clear()

    def clear(self):
        self.numbers, self.sent, self.arrived, self.stamps, self.data = [], [], [], [], []

    def take(self, keep=False):
        """Take what has come; keep: its bytes too."""
        with self._handle:
            while (taken := self._handle.take_message(self.kind, True)) is not None:
                data, info = taken
                self.numbers.append(info['publication_sequence_number'])
                self.sent.append(info['source_timestamp'])
                self.arrived.append(info['received_timestamp'])
                # The stamp is the first thing in all that has a header; 4 bytes say "CDR".
                seconds, nanoseconds = struct.unpack_from('<iI', data, 4)
                self.stamps.append(10 ** 9 * seconds + nanoseconds)
                if keep:
                    self.data.append(data)


def measure(ears, publisher, seconds, rate, commands=0):
    """Listen for some seconds, sending so many commands a second; return what came, in figures."""
    for ear in ears:
        ear.take()
        ear.clear()
    start, used = time.perf_counter(), cpu()
    sent = listen(ears, publisher, start + seconds, commands)
    used = (cpu() - used) / (time.perf_counter() - start)
    by_topic = {ear.topic: ear for ear in ears}
    probe = by_topic.get(PROBE, ears[0])
    result = {'cpu': used, 'topics': {ear.topic: counts(ear, rate) for ear in ears},
              'sending': deviations(probe.sent, rate), 'arriving': deviations(probe.arrived, rate)}
    if sent:
        result['latency'] = latencies(sent, by_topic[HAND])
    return result


def listen(ears, publisher, end, commands):
    """Take what comes until `end`; return {position commanded: when [ns]}."""
    sent, due = {}, 0.0
    while (now := time.perf_counter()) < end:
        if commands and now >= due:
            position = 1e-4 * (len(sent) + 1)
            message = PointStamped()
            message.header.frame_id = 'world'
            message.point.x, message.point.z = position, 2.0
            sent[position] = time.time_ns()
            publisher.publish(message)
            # At all phases of the node's tick alike.
            due = now + random.uniform(0.5, 1.5) / commands
        for ear in ears:
            ear.take(keep=bool(commands) and ear.topic == HAND)
        time.sleep(min(LOOK, max(due - time.perf_counter(), 0.0)) if commands else LOOK)
    return sent


def counts(ear, rate):
    """
    Return how many messages were sent and lost, and what was not sent, of the first to the last.

    missed: ticks that lack for the rate; gaps: times that two messages in a row are not one tick
    of simulated time apart (of a node whose stamps are simulated time).
    """
    numbers, sent = np.array(ear.numbers), np.array(ear.sent)
    if len(numbers) < 2:
        return {'received': len(numbers), 'sent': len(numbers), 'lost': 0, 'rate': 0.0,
                'missed': None, 'gaps': 0}
    count, span = int(numbers[-1] - numbers[0]), (sent[-1] - sent[0]) / 1e9
    off = abs(np.diff(ear.stamps) - 1e9 / rate) > 1.5
    lacking = round((span - MADE_UP) * rate) - count
    return {'received': len(numbers), 'sent': count + 1, 'lost': count + 1 - len(numbers),
            'rate': count / span, 'missed': max(lacking, 0),
            'gaps': int((off & (np.diff(numbers) == 1)).sum())}


def deviations(times, rate):
    """
    Return by how much the intervals between times [ns] are off, as percentiles [us].

    usual max: the median of the largest ones in each stretch of a length, over whole stretches.
    """
    off = abs(np.diff(times) / 1e3 - 1e6 / rate)
    if len(off) == 0:
        return None
    count = round(STRETCH * rate)
    stretches = off[:len(off) // count * count].reshape(-1, count)
    return {'p50': float(np.percentile(off, 50)), 'p99': float(np.percentile(off, 99)),
            'max': float(off.max()), 'usual max': float(np.median(stretches.max(axis=1)))}


def latencies(sent, hand):
    """Return the times from a command to what first shows it, as percentiles [us]."""
    first = {}
    for data, arrived in zip(hand.data, hand.arrived):
        first.setdefault(deserialize_message(data, hand.kind).pose.position.x, arrived)
    found = [(first[x] - when) / 1e3 for x, when in sent.items() if x in first]
    return {'commands': len(sent), 'seen': len(found), 'p50': float(np.percentile(found, 50)),
            'p99': float(np.percentile(found, 99)), 'max': max(found)}


def cpu():
    """Return the processor time of this process [s]."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


if __name__ == '__main__':
    main()
