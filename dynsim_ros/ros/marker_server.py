# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Interactive markers, which people take hold of in RViz, where interactive_markers is not installed.

The methods that are used here are called as those of the library's InteractiveMarkerServer, and do
the same; the topics and the service are those that RViz knows.
"""

import time

from visualization_msgs.msg import (InteractiveMarkerFeedback, InteractiveMarkerPose,
                                    InteractiveMarkerUpdate)
from visualization_msgs.srv import GetInteractiveMarkers

_DEPTH = 100
# For so long after somebody has moved a marker nobody else can [s].
_HOLD = 1.0


class MarkerServer:
    """
    Shows interactive markers on the topics and the service below a namespace.

    Changes are told by applyChanges; who comes later asks the service for all there is.
    """

    def __init__(self, node, namespace):
        self._node = node
        self._markers, self._feel, self._holders = {}, {}, {}
        self._changed, self._moved = {}, {}
        self._number = 0
        self._updates = node.create_publisher(
            InteractiveMarkerUpdate, f'{namespace}/update', _DEPTH)
        self._service = node.create_service(
            GetInteractiveMarkers, f'{namespace}/get_interactive_markers', self._tell)
        self._feedback = node.create_subscription(
            InteractiveMarkerFeedback, f'{namespace}/feedback', self._take, _DEPTH)

    def insert(self, marker, *, feedback_callback):
        """Add an InteractiveMarker; feedback_callback(feedback): called when it is touched."""
        self._changed[marker.name] = marker
        self._feel[marker.name] = feedback_callback

    def setPose(self, name, pose):
        """Put a marker somewhere else."""
        self._moved[name] = pose

    def applyChanges(self):
        """Let all changes since the last time take effect together, and tell who looks on."""
        if not self._changed and not self._moved:
            return
        self._markers.update(self._changed)
        poses = []
        for name, pose in self._moved.items():
            marker = self._markers[name]
            marker.pose = pose
            poses.append(InteractiveMarkerPose(header=marker.header, pose=pose, name=name))
        self._publish(markers=list(self._changed.values()), poses=poses)
        self._changed, self._moved = {}, {}

    def shutdown(self):
        """Take all markers away, for good."""
        self._publish(erases=list(self._markers))
        self._node.destroy_publisher(self._updates)
        self._node.destroy_service(self._service)
        self._node.destroy_subscription(self._feedback)

    def _publish(self, **changes):
        # Who looks on drops what is not newer than the answer of the service.
        self._number += 1
        self._updates.publish(InteractiveMarkerUpdate(
            server_id=self._node.get_fully_qualified_name(), seq_num=self._number,
            type=InteractiveMarkerUpdate.UPDATE, **changes))

    def _tell(self, request, response):
        response.sequence_number = self._number
        response.markers = list(self._markers.values())
        return response

    def _take(self, feedback):
        name, now = feedback.marker_name, time.monotonic()
        if name not in self._markers:
            return
        holder, since = self._holders.get(name, (feedback.client_id, now))
        if holder != feedback.client_id and now < since + _HOLD:
            return  # two people at once
        self._holders[name] = feedback.client_id, now
        if feedback.event_type == InteractiveMarkerFeedback.POSE_UPDATE:
            self.setPose(name, feedback.pose)
        self._feel[name](feedback)
