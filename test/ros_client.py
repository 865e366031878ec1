# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A ROS node in the test's own process: listens, commands, calls services of a node."""

from importlib import import_module
import math
import time

from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    ListParameters,
    SetParameters,
    SetParametersAtomically,
)
import rclpy
from rclpy.duration import Duration
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import deserialize_message
from rclpy.task import Future
from std_srvs.srv import SetBool, Trigger

DEEP = QoSProfile(depth=20_000)
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def type_named(name):
    """Return the class of 'package/msg/Name'."""
    package, folder, name = name.split('/')
    return getattr(import_module(f'{package}.{folder}'), name)


def nanoseconds(stamp):
    """Return a builtin_interfaces/Time as an integer [ns]."""
    return stamp.sec * 10 ** 9 + stamp.nanosec


def stamps(messages):
    """Return the stamps [ns] of messages with a header."""
    return [nanoseconds(message.header.stamp) for message in messages]


class Client:
    """
    Talks to the node of a full name; topics and services are relative to it.

    Nothing is served in the background: messages queue up, without loss, until the test waits.
    heard: {topic: list of messages as bytes}.
    """

    def __init__(self, target='/dynsim', check=lambda: None):
        """Take part in ROS; to be closed. check: raises if it is useless to wait any longer."""
        self._target = target
        self._check = check
        self._context = rclpy.Context()
        rclpy.init(context=self._context)
        self.node = Node('client', context=self._context, enable_rosout=False,
                         start_parameter_services=False)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self._services = {}
        self._publishers = {}
        self._types = {}
        self.heard = {}

    def close(self):
        """Leave ROS."""
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.shutdown(context=self._context)

    def full(self, name):
        """Return the full name of a topic or service."""
        return name if name.startswith('/') else f'{self._target}/{name}'

    def wait(self, condition, timeout=60.0):
        """Serve until condition() returns something true; return it."""
        limit = time.monotonic() + timeout
        while not (result := condition()):
            self._check()
            assert time.monotonic() < limit, f'waited {timeout} s in vain'
            self._executor.spin_once(timeout_sec=0.02)
        return result

    def drain(self):
        """Serve until nothing more arrives: for when the node is paused."""
        limit = time.monotonic() + 10.0
        quiet = 0
        while quiet < 3:
            assert time.monotonic() < limit, 'messages arrive without end'
            before = sum(map(len, self.heard.values()))
            self._executor.spin_once(timeout_sec=0.03)
            quiet = quiet + 1 if before == sum(map(len, self.heard.values())) else 0

    def listen(self, topics, qos=DEEP, is_served=True):
        """
        Subscribe to {topic: type name} and wait until each is found, also by its publisher.

        is_served: the target serves its parameters.
        """
        found = []
        for topic, type_name in topics.items():
            self._types[topic] = type_named(type_name)
            self.heard[topic] = []
            found.append(self.node.create_subscription(
                self._types[topic], self.full(topic), self.heard[topic].append, qos, raw=True))
        for subscription in found:
            self.wait(lambda subscription=subscription: subscription.get_publisher_count())
        if is_served:
            self._be_found()

    def _be_found(self):
        """
        Wait until the target has found all readers of this client.

        A participant tells of its readers one after the other: who can answer a client of a
        service made now has found what was made before.
        """
        client = self.node.create_client(ListParameters, self.full('list_parameters'))
        self.wait(client.service_is_ready)
        answers, asked = [], -math.inf
        while not any(map(Future.done, answers)):
            # an answer to a reader that is not found within 0.1 s is lost
            if time.monotonic() > asked + 1.0:
                answers.append(client.call_async(ListParameters.Request()))
                asked = time.monotonic()
            self._check()
            assert len(answers) < 60, 'nobody answers'
            self._executor.spin_once(timeout_sec=0.02)
        self.node.destroy_client(client)

    def messages(self, topic):
        """Return what was heard on a topic, as messages."""
        return [deserialize_message(data, self._types[topic])
                for data in list(self.heard[topic])]

    def last(self, topic):
        """Return the message that was heard last on a topic."""
        return deserialize_message(self.heard[topic][-1], self._types[topic])

    def more(self, topic, count=1):
        """Wait for so many more messages of a topic; return all those that came."""
        before = len(self.heard[topic])
        self.wait(lambda: len(self.heard[topic]) >= before + count)
        return self.messages(topic)[before:]

    def clear(self):
        """Forget what was heard."""
        self.drain()
        for heard in self.heard.values():
            heard.clear()

    def publish(self, topic, message, qos=10):
        """
        Publish a message after a subscriber was found.

        A subscriber may find the publisher later than that finds it; a service called meanwhile
        would overtake the message. Hence wait until the first message is there.
        """
        topic = self.full(topic)
        if topic not in self._publishers:
            publisher = self.node.create_publisher(type(message), topic, qos)
            self.wait(publisher.get_subscription_count)
            self._publishers[topic] = publisher
            publisher.publish(message)
            assert publisher.wait_for_all_acked(Duration(seconds=10))
        else:
            self._publishers[topic].publish(message)

    def call_async(self, name, kind, **fields):
        """Call a service; return the future."""
        if name not in self._services:
            self._services[name] = self.node.create_client(kind, self.full(name))
            self.wait(self._services[name].service_is_ready)
        return self._services[name].call_async(kind.Request(**fields))

    def call(self, name, kind, **fields):
        """Call a service and return its response."""
        future = self.call_async(name, kind, **fields)
        self.wait(future.done)
        return future.result()

    def pause(self, data=True):
        """Call ~/pause and wait for what was published before; return the response."""
        response = self.call('pause', SetBool, data=data)
        if data and response.success:
            time_ns = float(response.message.split()[4]) * 1e9
            for topic, heard in self.heard.items():
                if topic.endswith('/pose') and heard:
                    self.wait(lambda topic=topic: stamps([self.last(topic)])[0] > time_ns - 5e4)
        return response

    def record(self, data):
        """Call ~/record; return the response."""
        return self.call('record', SetBool, data=data)

    def recorder_status(self):
        """Return the recorder's status in the next /diagnostics, which are listened to."""
        array, *_ = self.more('/diagnostics')
        return array.status[3]

    def step(self):
        """Call ~/step; return the response."""
        return self.call('step', Trigger)

    def reset(self):
        """Call ~/reset; return the response."""
        return self.call('reset', Trigger)

    def steps(self, count, topic):
        """Step so often, wait for what is published each time; return the messages of topic."""
        before = len(self.heard[topic])
        for _ in range(count):
            response = self.step()
            assert response.success, response.message
        self.wait(lambda: len(self.heard[topic]) >= before + count)
        self.drain()
        return self.messages(topic)[before:]

    def configure(self, values):
        """Set parameters one by one; return [SetParametersResult]."""
        return self.call('set_parameters', SetParameters, parameters=_messages(values)).results

    def set_group(self, values):
        """Set parameters all or none; return the SetParametersResult."""
        return self.call('set_parameters_atomically', SetParametersAtomically,
                         parameters=_messages(values)).result

    def get(self, *names):
        """Return the values of parameters."""
        values = self.call('get_parameters', GetParameters, names=names).values
        return [parameter_value_to_python(value) for value in values]

    def describe(self, *names):
        """Return the descriptors of parameters."""
        return self.call('describe_parameters', DescribeParameters, names=names).descriptors

    def parameter_names(self):
        """Return the names of all parameters."""
        return self.call('list_parameters', ListParameters).result.names


def _messages(values):
    return [Parameter(name, value=value).to_parameter_msg() for name, value in values.items()]
