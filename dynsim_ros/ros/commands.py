# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Commands by topic: anchors, pushes, single parameters; and anchors that are dragged."""

from geometry_msgs.msg import PointStamped, WrenchStamped
from rcl_interfaces.msg import Parameter as ParameterMessage
from rclpy.parameter import Parameter
from rclpy.qos_overriding_options import QoSOverridingOptions

from .context import one_line
from .qos import profile
from ..messages.channel import WORLD
from ..messages.commands import anchor_topic, PARAMETER_TOPIC, POINT, push_topic, WRENCH
from ..messages.qos import COMMAND
from ..messages.reading import Reading
from ..scene import SceneError
from ..simulation import CommandError, MoveAnchor, PushBody
from ..simulation.commands import checked

# At most one warning about refused commands in so many seconds.
_THROTTLE = 1.0
_FRAMES = WORLD, ''
_POINT = tuple(f'point.{axis}' for axis in 'xyz')
_WRENCH = tuple(f'wrench.{part}.{axis}' for part in ('force', 'torque') for axis in 'xyz')


class Commands:
    """
    Subscribes to the command topics of a scene and tells what is valid to the run's mailbox.

    A refused command leaves the state as it is; it is counted in run.refused, and a warning
    (throttled) says what is wrong with it.
    """

    def __init__(self, node, run, mailbox):
        self._node = node
        self._run = run
        self._mailbox = mailbox
        scene = run.simulator.scene
        # To lay a message out takes longer than to read many: once for all topics of a type.
        points, wrenches = Reading(POINT, _POINT, _FRAMES), Reading(WRENCH, _WRENCH, _FRAMES)
        for anchor in scene.anchors:
            self._read(PointStamped, anchor_topic(anchor.name), points,
                       lambda point, name=anchor.name: MoveAnchor(name, point))
        for body in scene.bodies:
            self._read(WrenchStamped, push_topic(body.name), wrenches,
                       lambda wrench, name=body.name: PushBody(name, wrench[:3], wrench[3:]))
        self._subscribe(ParameterMessage, PARAMETER_TOPIC, self._set)

    def drag(self, topic, anchor, header, point):
        """Move an anchor to where it was dragged to, as told on some topic."""
        self._guarded(topic, lambda: self._tell(
            header.frame_id, MoveAnchor(anchor, numbers(point))))

    def _read(self, message_type, topic, reading, make):
        """Subscribe to a topic whose bytes are read, and made a command of."""
        # To make an object of a message takes as long as all that is done with it.
        def take(data):
            try:
                frame_id, found = reading(data)
            except ValueError as error:
                raise CommandError(str(error)) from None
            self._tell(frame_id, make(found))

        self._subscribe(message_type, topic, take, raw=True)

    def _subscribe(self, message_type, topic, callback, raw=False):
        self._node.create_subscription(
            message_type, f'~/{topic}',
            lambda message: self._guarded(topic, lambda: callback(message)), profile(COMMAND),
            qos_overriding_options=QoSOverridingOptions.with_default_policies(), raw=raw)

    def _guarded(self, topic, action):
        try:
            action()
        except SceneError as error:
            self._run.refused += 1
            self._node.get_logger().warning(f'~/{topic} refused: {error}',
                                            throttle_duration_sec=_THROTTLE)

    def _tell(self, frame_id, command):
        """Have a command carried out if it is valid: which names there are never changes."""
        check_frame(frame_id)
        command = checked(command, self._run.simulator.scene)
        self._mailbox.tell(lambda: self._run.carry_out(command))

    def _set(self, message):
        try:
            parameter = Parameter.from_parameter_msg(message)
        except (TypeError, ValueError) as error:
            raise CommandError(f'{message.name}: {one_line(error)}') from None
        result = self._node.set_parameters_atomically([parameter])
        if not result.successful:
            raise CommandError(result.reason)


def check_frame(frame_id):
    """Raise CommandError unless a command is in the world frame (or names none)."""
    if frame_id not in _FRAMES:
        raise CommandError(f"frame '{frame_id}' is not known; give it in '{WORLD}'")


def numbers(vector):
    """Return the components of a vector or point: (3,)."""
    return (vector.x, vector.y, vector.z)
