# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Interactive markers as RViz shows them: all that there is first, then every change."""

from visualization_msgs.msg import InteractiveMarkerFeedback
from visualization_msgs.srv import GetInteractiveMarkers

UPDATE = 'visualization_msgs/msg/InteractiveMarkerUpdate'


class RViz:
    """
    Looks at the markers below a namespace, through a Client of the node.

    markers: {name: InteractiveMarker} as they are shown; look() brings them up to date.
    """

    def __init__(self, client, namespace='handles'):
        self._client, self._namespace = client, namespace
        client.listen({f'{namespace}/update': UPDATE})
        self._seen = 0
        self._ask()

    def look(self):
        """Apply the changes that have come, or ask anew where one is missing; return markers."""
        updates = self._client.messages(f'{self._namespace}/update')
        for update in updates[self._seen:]:
            assert update.type == update.UPDATE
            if update.seq_num == self._number + 1:
                self._apply(update)
            elif update.seq_num > self._number:
                self._ask()
        self._seen = len(updates)
        return self.markers

    def _ask(self):
        response = self._client.call(f'{self._namespace}/get_interactive_markers',
                                     GetInteractiveMarkers)
        self._number = response.sequence_number
        self.markers = {marker.name: marker for marker in response.markers}

    def _apply(self, update):
        self._number = update.seq_num
        for marker in update.markers:
            self.markers[marker.name] = marker
        for moved in update.poses:
            self.markers[moved.name].pose = moved.pose
        for name in update.erases:
            del self.markers[name]

    def place(self, name):
        """Return where a marker is shown: [x, y, z]."""
        p = self.look()[name].pose.position
        return [p.x, p.y, p.z]

    def drag(self, name, place, frame='world', user='/rviz'):
        """Let somebody drag a marker to a place."""
        message = InteractiveMarkerFeedback(
            marker_name=name, client_id=user, control_name='move',
            event_type=InteractiveMarkerFeedback.POSE_UPDATE)
        message.header.frame_id = frame
        p = message.pose.position
        p.x, p.y, p.z = place
        self._client.publish(f'{self._namespace}/feedback', message)
