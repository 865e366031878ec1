# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Handles by which anchors are dragged in RViz."""

from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import InteractiveMarker, InteractiveMarkerControl, Marker

from ..messages.channel import WORLD
from ..messages.markers import drawing_scale
try:
    from interactive_markers import InteractiveMarkerServer
except ImportError:
    # ROS on PyPI lacks it.
    from .marker_server import MarkerServer as InteractiveMarkerServer

_TOPIC = 'handles'
# How often handles follow their anchors while somebody looks on [s].
_PERIOD = 0.1
_HALF = 0.5 ** 0.5
# What turns the x axis of a control into each axis of the world.
_TURNS = {'x': Quaternion(x=_HALF, w=_HALF), 'y': Quaternion(z=_HALF, w=_HALF),
          'z': Quaternion(y=_HALF, w=_HALF)}


def handles_for(node, scene, snapshot, drag):
    """
    Return Handles for a scene, None where there is no anchor.

    snapshot(): returns a Snapshot of the run; drag(topic, anchor, header, point): called when an
    anchor is dragged.
    """
    return Handles(node, scene, snapshot, drag) if scene.anchors else None


class Handles:
    """A handle for each anchor of a scene, which it follows, quicker where somebody sees it."""

    def __init__(self, node, scene, snapshot, drag):
        self._node, self._snapshot, self._drag = node, snapshot, drag
        self._server = InteractiveMarkerServer(node, f'~/{_TOPIC}')
        self._updates = node.resolve_topic_name(f'~/{_TOPIC}/update')
        self._places = {anchor.name: tuple(anchor.position) for anchor in scene.anchors}
        for name, place in self._places.items():
            self._server.insert(_handle(name, place, drawing_scale(scene)),
                                feedback_callback=self._feel)
        self._server.applyChanges()
        self._timer = node.create_timer(_PERIOD, self._follow, autostart=False,
                                        clock=Clock(clock_type=ClockType.STEADY_TIME))

    def look(self):
        """Put the handles where the anchors are; go on with that if there is who sees them."""
        self._follow()
        is_seen = self._node.count_subscribers(self._updates) > 0
        if not is_seen:
            self._timer.cancel()
        elif self._timer.is_canceled():
            self._timer.reset()

    def end(self):
        """Take the handles away; while ROS is still there."""
        self._timer.cancel()
        self._server.shutdown()

    def _follow(self):
        snapshot = self._snapshot()
        for name, before in self._places.items():
            place = tuple(snapshot.anchor_position(name).tolist())
            if place != before:
                self._server.setPose(name, _pose(place))
                self._places[name] = place
        self._server.applyChanges()

    def _feel(self, feedback):
        if feedback.event_type == feedback.POSE_UPDATE:
            # It goes back to its anchor, should that not be let go where it was dragged to.
            self._places[feedback.marker_name] = None
            self._drag(f'{_TOPIC}/feedback', feedback.marker_name, feedback.header,
                       feedback.pose.position)


def _handle(name, place, scale):
    """Return a handle to drag along each axis, or by its middle."""
    marker = InteractiveMarker(name=name, description=name, scale=3.0 * scale, pose=_pose(place))
    marker.header.frame_id = WORLD
    ball = Marker(type=Marker.SPHERE, scale=Vector3(x=scale, y=scale, z=scale),
                  color=ColorRGBA(r=0.9, g=0.3, b=0.2, a=0.4))
    marker.controls = [InteractiveMarkerControl(
        name='move', interaction_mode=InteractiveMarkerControl.MOVE_3D, always_visible=True,
        markers=[ball])]
    marker.controls += [InteractiveMarkerControl(
        name=f'move_{axis}', interaction_mode=InteractiveMarkerControl.MOVE_AXIS,
        orientation=turn) for axis, turn in _TURNS.items()]
    return marker


def _pose(place):
    return Pose(position=Point(**dict(zip('xyz', place))))
