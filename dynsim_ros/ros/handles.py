# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Handles by which anchors are dragged in RViz, where interactive_markers is installed."""

from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import InteractiveMarker, InteractiveMarkerControl, Marker

from ..messages.channel import WORLD
from ..messages.markers import drawing_scale
try:
    from interactive_markers import InteractiveMarkerServer
except ImportError:
    # ROS on PyPI lacks it.
    InteractiveMarkerServer = None

_TOPIC = 'handles'
_HALF = 0.5 ** 0.5
# What turns the x axis of a control into each axis of the world.
_TURNS = {'x': Quaternion(x=_HALF, w=_HALF), 'y': Quaternion(z=_HALF, w=_HALF),
          'z': Quaternion(y=_HALF, w=_HALF)}


def handles_for(node, scene, drag):
    """
    Return Handles for a scene, None where there is no anchor or no library for them.

    drag(topic, anchor, header, point): called when an anchor is dragged.
    """
    if InteractiveMarkerServer is None or not scene.anchors:
        return None
    return Handles(node, scene, drag)


class Handles:
    """A handle for each anchor of a scene; those of one that moves otherwise follow it."""

    def __init__(self, node, scene, drag):
        self._drag = drag
        self._server = InteractiveMarkerServer(node, f'~/{_TOPIC}')
        self._places = {anchor.name: tuple(anchor.position) for anchor in scene.anchors}
        for name, place in self._places.items():
            self._server.insert(_handle(name, place, drawing_scale(scene)),
                                feedback_callback=self._feel)
        self._server.applyChanges()

    def follow(self, snapshot):
        """Put the handles where the anchors are now."""
        moved = {name: tuple(snapshot.anchor_position(name).tolist()) for name in self._places}
        for name in [name for name, place in moved.items() if place != self._places[name]]:
            self._server.setPose(name, _pose(moved[name]))
        self._places = moved
        self._server.applyChanges()

    def end(self):
        """Take the handles away; while ROS is still there."""
        self._server.shutdown()

    def _feel(self, feedback):
        if feedback.event_type == feedback.POSE_UPDATE:
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
