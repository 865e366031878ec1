# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A simulation node as another process sees it: by topics, services and parameters alone."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
import os
import time

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped, WrenchStamped
from rcl_interfaces.msg import ParameterEvent
from rclpy.exceptions import NameValidationException
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient
from rclpy.qos import qos_profile_parameter_events
from rclpy.validate_full_topic_name import validate_full_topic_name
from std_srvs.srv import SetBool, Trigger

from .listener import Listener
from .qos import profile
from ..messages.channel import WORLD
from ..messages.commands import anchor_topic, push_topic
from ..messages.qos import COMMAND

_SERVICES = {'pause': SetBool, 'record': SetBool, 'step': Trigger, 'reset': Trigger}


class RemoteError(ValueError):
    """A simulation that does not answer; one line of text."""


def _check_name(name):
    """Raise RemoteError unless it is the full name of a node."""
    try:
        validate_full_topic_name(name)
    except NameValidationException as error:
        reason = str(error).splitlines()[0]
        raise RemoteError(f"--node: '{name}' is no full name of a node, such as /dynsim: "
                          f'{reason}') from None


class RemoteSimulation:
    """
    The simulation node of a full name, such as '/dynsim'.

    node: served by the caller; ears: another one, served by nobody. topics: {name relative to
    the simulation: type name}; values, descriptors: of its parameters, by name; values are those
    in force. changed: called with {name: value} of parameters that were set, by anybody.
    """

    def __init__(self, node: Node, ears: Node, name: str,
                 changed: Callable[[Mapping], None] = lambda values: None):
        _check_name(name)
        self.name = name
        self.changed = changed
        self.topics: dict[str, str] = {}
        self.values: dict[str, object] = {}
        self.descriptors: dict[str, object] = {}
        # What it says of its run and of its recorder: (level, message, {key: value}).
        self.status: dict[str, tuple] = {}
        self._node = node
        self._listener = Listener(ears)
        self._parameters = AsyncParameterClient(node, name)
        self._publishers: dict[str, object] = {}
        self._services = {service: node.create_client(kind, f'{name}/{service}')
                          for service, kind in _SERVICES.items()}
        node.create_subscription(ParameterEvent, '/parameter_events', self._take_event,
                                 qos_profile_parameter_events)
        node.create_subscription(DiagnosticArray, '/diagnostics', self._take_diagnostics, 10)

    @property
    def is_there(self) -> bool:
        """Tell whether the node is there now."""
        return self._services['pause'].service_is_ready()

    def find(self, serve: Callable[[float], None], patience: float,
             stopped: Callable[[], bool] = lambda: False):
        """
        Wait for the node and get to know it; serve(seconds) serves `node`.

        Raises RemoteError if it does not answer within so many seconds.
        """
        limit = time.monotonic() + patience
        ready = (self._parameters.services_are_ready,
                 *(service.service_is_ready for service in self._services.values()),
                 self._find_topics)
        while not all(is_ready() for is_ready in ready):
            if stopped() or time.monotonic() > limit:
                raise RemoteError(
                    f"no simulation '{self.name}' answers within {patience:g} s: start one "
                    '(sim_node) with the same ROS_DOMAIN_ID and discovery range, or name it with '
                    '--node')
            serve(0.05)

        def answer(future):
            while not future.done():
                if stopped() or time.monotonic() > limit + patience:
                    raise RemoteError(f"'{self.name}' does not answer: is it stopped?")
                serve(0.05)
            return future.result()

        names = answer(self._parameters.list_parameters()).result.names
        values = answer(self._parameters.get_parameters(names)).values
        self.values = dict(zip(names, map(parameter_value_to_python, values)))
        described = answer(self._parameters.describe_parameters(names)).descriptors
        self.descriptors = dict(zip(names, described))

    def listen(self, topics):
        """Listen to some of the topics, given by their relative names, and to no others."""
        self._listener.listen({f'{self.name}/{topic}': self.topics[topic] for topic in topics})

    def take(self, topic: str) -> list[bytes]:
        """Return the messages of a topic that arrived since the last call."""
        return self._listener.take(f'{self.name}/{topic}')

    def move(self, anchor: str, position):
        """Command an anchor to a position: (3,) [m]."""
        message = PointStamped()
        message.header.frame_id = WORLD
        _fill(message.point, position)
        self._publisher(PointStamped, anchor_topic(anchor)).publish(message)

    def push(self, body: str, force, torque):
        """Push a body: force (3,) [N] at its centre of mass and torque (3,) [N m]."""
        message = WrenchStamped()
        message.header.frame_id = WORLD
        _fill(message.wrench.force, force)
        _fill(message.wrench.torque, torque)
        self._publisher(WrenchStamped, push_topic(body)).publish(message)

    def call(self, service: str, value: bool | None, done: Callable[[bool, str], None]):
        """Call a service; done(success, message) is called with the answer."""
        kind = _SERVICES[service]
        request = kind.Request() if value is None else kind.Request(data=value)
        if not self._services[service].service_is_ready():
            done(False, f"'{self.name}' is not there")
            return
        future = self._services[service].call_async(request)
        future.add_done_callback(
            lambda future: done(future.result().success, future.result().message))

    def set_values(self, values: Mapping, done: Callable[[str | None], None]):
        """Set parameters, all or none; done(why not) is called with the answer, None if set."""
        future = self._parameters.set_parameters_atomically(
            [Parameter(name, value=value) for name, value in values.items()])
        future.add_done_callback(lambda future: done(
            None if future.result().result.successful else future.result().result.reason))

    def _publisher(self, kind, topic):
        if topic not in self._publishers:
            self._publishers[topic] = self._node.create_publisher(
                kind, f'{self.name}/{topic}', profile(COMMAND))
        return self._publishers[topic]

    def _find_topics(self) -> bool:
        """Look up what the node publishes; tell whether its poses are there."""
        namespace, _, name = self.name.rpartition('/')
        try:
            found = self._node.get_publisher_names_and_types_by_node(name, namespace or '/')
        except (RuntimeError, ValueError):
            return False  # not found yet, or no name that a node can have
        self.topics = {topic.removeprefix(f'{self.name}/'): types[0] for topic, types in found
                       if topic.startswith(f'{self.name}/')}
        return 'energy' in self.topics

    def _take_event(self, event):
        if event.node != self.name or not self.values:
            return
        values = {parameter.name: parameter_value_to_python(parameter.value)
                  for parameter in (*event.new_parameters, *event.changed_parameters)}
        self.values.update(values)
        self.changed(values)

    def _take_diagnostics(self, array):
        # Their names do not have the namespace: of two nodes of one name nobody knows which it is.
        name = self.name.rpartition('/')[2]
        publishers = self._node.get_publishers_info_by_topic('/diagnostics')
        if sum(publisher.node_name == name for publisher in publishers) > 1:
            self.status.clear()
            return
        for status in array.status:
            of, _, task = status.name.partition(': ')
            if of == name:
                level = int.from_bytes(status.level, 'little')
                self.status[task] = (level, status.message,
                                     {pair.key: pair.value for pair in status.values})


@contextmanager
def new_remote(name: str) -> Iterator[tuple[RemoteSimulation, Node]]:
    """Give a RemoteSimulation of a full name and the node that has to be served for it."""
    # Others may look at the same simulation.
    own = f'dynsim_view_{os.getpid()}'
    nodes = [Node(f'{own}{suffix}', enable_rosout=False, start_parameter_services=False)
             for suffix in ('', '_ears')]
    try:
        yield RemoteSimulation(*nodes, name), nodes[0]
    finally:
        for node in nodes:
            node.destroy_node()


def _fill(vector, numbers):
    vector.x, vector.y, vector.z = map(float, numbers)
