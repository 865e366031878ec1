# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Handles for RViz, by which anchors are dragged.

PyPI has no interactive_markers. In its place there is a package of that name with as much of its
server as is used, on the topics and the service that RViz knows.
"""

import os

import pytest
from scene_topics import DIAGNOSTICS, POSE, positions
from visualization_msgs.msg import InteractiveMarkerControl, InteractiveMarkerFeedback
from visualization_msgs.srv import GetInteractiveMarkers

UPDATE = 'visualization_msgs/msg/InteractiveMarkerUpdate'
SERVER = """
from visualization_msgs.msg import (InteractiveMarkerFeedback, InteractiveMarkerPose,
                                    InteractiveMarkerUpdate)
from visualization_msgs.srv import GetInteractiveMarkers


class InteractiveMarkerServer:
    def __init__(self, node, namespace):
        self.markers, self.callbacks, self.moved = {}, {}, []
        self.publisher = node.create_publisher(
            InteractiveMarkerUpdate, f'{namespace}/update', 100)
        node.create_service(
            GetInteractiveMarkers, f'{namespace}/get_interactive_markers', self.tell)
        node.create_subscription(
            InteractiveMarkerFeedback, f'{namespace}/feedback', self.take, 1)

    def insert(self, marker, *, feedback_callback=None):
        self.markers[marker.name], self.callbacks[marker.name] = marker, feedback_callback

    def setPose(self, name, pose):
        self.markers[name].pose = pose
        self.moved.append(InteractiveMarkerPose(
            name=name, pose=pose, header=self.markers[name].header))

    def applyChanges(self):
        if self.moved:
            self.publisher.publish(InteractiveMarkerUpdate(poses=self.moved))
        self.moved = []

    def shutdown(self):
        print('handles taken away')

    def tell(self, request, response):
        response.markers = list(self.markers.values())
        return response

    def take(self, feedback):
        if feedback.marker_name in self.markers:
            self.callbacks[feedback.marker_name](feedback)
"""


@pytest.fixture(scope='module')
def node(start, tmp_path_factory):
    folder = tmp_path_factory.mktemp('stand_in')
    (folder / 'interactive_markers').mkdir()
    (folder / 'interactive_markers' / '__init__.py').write_text(SERVER)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('PYTHONPATH', f'{folder}{os.pathsep}{os.environ["PYTHONPATH"]}')
        return start()


@pytest.fixture(scope='module')
def client(node, connect):
    client = connect(node)
    client.listen({'hand/pose': POSE, 'handles/update': UPDATE, '/diagnostics': DIAGNOSTICS})
    return client


def feedback(x, frame='world'):
    message = InteractiveMarkerFeedback(
        marker_name='hand', client_id='rviz', event_type=InteractiveMarkerFeedback.POSE_UPDATE)
    message.header.frame_id = frame
    message.pose.position.x, message.pose.position.z = x, 2.2
    return message


def hand(client):
    return list(positions([client.last('hand/pose')])[0])


def test_rviz_is_given_a_handle_at_the_anchor(client):
    (marker,) = client.call('handles/get_interactive_markers', GetInteractiveMarkers).markers
    assert (marker.name, marker.header.frame_id, marker.pose.position.z) == ('hand', 'world', 2.0)
    modes = [control.interaction_mode for control in marker.controls]
    assert modes == [InteractiveMarkerControl.MOVE_3D] + 3 * [InteractiveMarkerControl.MOVE_AXIS]


def test_the_anchor_follows_the_handle(client):
    client.publish('handles/feedback', feedback(0.25))
    client.wait(lambda: client.heard['hand/pose'] and hand(client) == [0.25, 0.0, 2.2])


def test_the_handle_follows_the_anchor(client):
    client.wait(lambda: client.heard['handles/update'])
    client.reset()
    client.wait(lambda: client.last('handles/update').poses[0].pose.position.x == 0.0)
    (moved,) = client.last('handles/update').poses
    assert (moved.name, moved.pose.position.z) == ('hand', 2.0)


def test_another_frame_is_refused(client, node):
    client.publish('handles/feedback', feedback(0.5, 'elsewhere'))
    client.wait(lambda: 'refused' in node.output)
    assert "~/handles/feedback refused: frame 'elsewhere' is not known; give it in 'world'" in (
        node.output)
    assert hand(client) == [0.0, 0.0, 2.0]


def test_it_ends_well(node):
    assert 'handles taken away' in node.stop()
