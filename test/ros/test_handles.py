# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Handles by which anchors are dragged, looked at and taken hold of as RViz does."""

import time

from geometry_msgs.msg import Point, PointStamped
import pytest
from rviz import RViz
from scene_topics import DIAGNOSTICS, POSE, positions
from visualization_msgs.msg import InteractiveMarkerControl
from visualization_msgs.srv import GetInteractiveMarkers

# At L = 0.5 m + 9.81 N / (100 N/m) below its anchor.
STILL = """
gravity: 9.81
anchors: {hand: {position: [0, 0, 2]}}
bodies: {mass: {shape: particle, mass: 1, position: [0, 0, 1.4019]}}
springs: {spring: {from: hand, to: mass, stiffness: 100, damping: 1, natural_length: 0.5}}
"""


@pytest.fixture(scope='module')
def node(start):
    return start()


@pytest.fixture(scope='module')
def client(node, connect):
    client = connect(node)
    client.listen({'hand/pose': POSE, '/diagnostics': DIAGNOSTICS})
    return client


@pytest.fixture(scope='module')
def rviz(client):
    return RViz(client)


def hand(client):
    return list(positions([client.last('hand/pose')])[0])


def moved_to(x, y, z):
    return PointStamped(point=Point(x=x, y=y, z=z))


def test_there_is_a_handle_at_the_anchor(rviz):
    (marker,) = rviz.markers.values()
    assert (marker.name, marker.header.frame_id) == ('hand', 'world')
    assert rviz.place('hand') == [0.0, 0.0, 2.0]
    modes = [control.interaction_mode for control in marker.controls]
    assert modes == [InteractiveMarkerControl.MOVE_3D] + 3 * [InteractiveMarkerControl.MOVE_AXIS]


def test_the_anchor_follows_the_handle(client, rviz):
    rviz.drag('hand', (0.25, 0.0, 2.2))
    client.wait(lambda: client.heard['hand/pose'] and hand(client) == [0.25, 0.0, 2.2])
    client.wait(lambda: rviz.place('hand') == [0.25, 0.0, 2.2])


def test_the_handle_follows_the_anchor(client, rviz):
    client.reset()
    client.wait(lambda: rviz.place('hand') == [0.0, 0.0, 2.0])
    client.publish('hand/command', moved_to(-0.1, 0.0, 1.9))
    client.wait(lambda: rviz.place('hand') == [-0.1, 0.0, 1.9])


def test_who_comes_later_is_shown_the_same(client, rviz, connect, node):
    rviz.drag('hand', (0.0, 0.1, 2.0))
    client.wait(lambda: rviz.place('hand') == [0.0, 0.1, 2.0])
    assert RViz(connect(node)).place('hand') == [0.0, 0.1, 2.0]


def test_one_at_a_time_has_hold_of_a_handle(client, rviz):
    rviz.drag('hand', (0.0, 0.2, 2.0))
    rviz.drag('hand', (0.0, 0.9, 2.0), user='/somebody_else')
    rviz.drag('hand', (0.0, 0.3, 2.0))
    seen = set()

    def is_last():
        seen.update(y for _, y, _ in positions(client.messages('hand/pose')))
        return 0.3 in seen
    client.wait(is_last)
    assert 0.9 not in seen
    # After a while it is free.

    def is_taken_over():
        rviz.drag('hand', (0.0, 0.9, 2.0), user='/somebody_else')
        return hand(client) == [0.0, 0.9, 2.0]
    client.wait(is_taken_over)


def test_another_frame_is_refused_and_the_handle_goes_back(client, rviz, node):
    client.reset()
    client.wait(lambda: rviz.place('hand') == [0.0, 0.0, 2.0])
    before = rviz.look()['hand'].pose

    def is_refused():
        rviz.drag('hand', (0.5, 0.0, 2.0), frame='elsewhere')
        return 'refused' in node.output
    client.wait(is_refused)
    assert "~/handles/feedback refused: frame 'elsewhere' is not known; give it in 'world'" in (
        node.output)
    client.wait(lambda: rviz.look()['hand'].pose is not before)
    client.wait(lambda: rviz.place('hand') == [0.0, 0.0, 2.0])
    assert hand(client) == [0.0, 0.0, 2.0]


def test_no_such_handle(client, rviz):
    rviz.drag('foot', (0.0, 0.0, 2.0))
    rviz.drag('hand', (0.0, 0.0, 2.1))
    client.wait(lambda: rviz.place('hand') == [0.0, 0.0, 2.1])
    assert list(rviz.markers) == ['hand']


def test_they_go_with_the_node(client, node):
    node.stop()
    client.wait(lambda: not client.node.count_publishers(client.full('handles/update')))


def test_whom_it_touches_wakes(start, connect, tmp_path):
    """A scene at rest takes no step, until somebody drags what it hangs from."""
    scene = tmp_path / 'still.yaml'
    scene.write_text(STILL)
    client = connect(start('-p', f'scene:={scene}', '-r', '__ns:=/still', name='/still/dynsim'))
    client.listen({'mass/pose': POSE})
    rviz = RViz(client)
    assert len({tuple(place) for place in positions(client.more('mass/pose', 20))}) == 1
    rviz.drag('hand', (0.0, 0.0, 2.5))
    client.wait(lambda: positions([client.last('mass/pose')])[0][2] > 1.5)


def test_handles_follow_seldom_while_nobody_looks(start, connect):
    client = connect(start('-p', 'integrator:=rk4', '-r', '__ns:=/unseen', name='/unseen/dynsim'))

    def number():
        return client.call('handles/get_interactive_markers',
                           GetInteractiveMarkers).sequence_number

    client.listen({'hand/pose': POSE})
    client.set_group({'hand.velocity': [0.1, 0.0, 0.0]})
    begin, before = time.monotonic(), number()
    client.more('hand/pose', 300)
    seconds, told = time.monotonic() - begin, number() - before
    # Once a second, not ten times.
    assert 1 <= told <= seconds + 1.0
    # What is told then is where the anchor is, to within that second.
    rviz = RViz(client)
    client.wait(lambda: abs(rviz.place('hand')[0] - hand(client)[0]) < 0.02)
    seen = rviz.place('hand')
    client.wait(lambda: rviz.place('hand') != seen)


def test_a_handle_for_each_anchor_by_other_names(start, connect):
    renamed = [part for name in ('update', 'feedback', 'get_interactive_markers')
               for part in ('-r', f'~/handles/{name}:=/seen/{name}')]
    client = connect(start('-p', 'scene:=two_anchors', '-p', 'integrator:=rk4', *renamed,
                           '-r', '__ns:=/lab', name='/lab/dynsim'))
    rviz = RViz(client, '/seen')
    assert sorted(rviz.markers) == ['left', 'right']
    left = rviz.place('left')
    client.publish('right/command', moved_to(0.5, 0.0, 1.5))
    client.wait(lambda: rviz.place('right') == [0.5, 0.0, 1.5])
    assert rviz.place('left') == left


def test_a_scene_without_anchors_has_none(start, connect):
    client = connect(start('-p', 'scene:=falling_in_wind', '-p', 'integrator:=rk4',
                           '-r', '__ns:=/free', name='/free/dynsim'))
    client.listen({'ball/pose': POSE})
    topics = [name for name, _ in client.node.get_topic_names_and_types()]
    assert '/free/dynsim/ball/pose' in topics
    assert not [name for name in topics if name.startswith('/free') and 'handles' in name]
