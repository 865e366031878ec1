# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The frames of a scene, as rosbags reads them by the definition of tf2_msgs that it has."""

from dynsim_ros.messages.definitions import definition
from dynsim_ros.messages.transforms import frame, transform_channel, TRANSFORMS
from dynsim_ros.scene import load_scene, scene_names
from dynsim_ros.simulation import MoveAnchor, Simulator
import numpy as np
import pytest
from rosbags.typesys import get_typestore, Stores
from scene_topics import xyz

JAZZY = get_typestore(Stores.ROS2_JAZZY)
STAMP = 7_000_000_123


def transforms(simulator, node='/dynsim'):
    """Return {child frame: TransformStamped} at the present instant."""
    channel = transform_channel(simulator.scene, node)
    data = channel.encode(simulator.snapshot(), STAMP)
    found = JAZZY.deserialize_cdr(data, TRANSFORMS).transforms
    for part in found:
        assert part.header.frame_id == 'world'
        assert (part.header.stamp.sec, part.header.stamp.nanosec) == (7, 123)
    assert len({part.child_frame_id for part in found}) == len(found)
    return {part.child_frame_id: part.transform for part in found}


def turn(transform):
    """Return a rotation as (w, x, y, z)."""
    q = transform.rotation
    return [q.w, q.x, q.y, q.z]


def test_the_shipped_definition_is_that_of_jazzy():
    described = definition(TRANSFORMS)
    assert described.type_hash == JAZZY.hash_rihs01(TRANSFORMS)
    assert 'MSG: geometry_msgs/TransformStamped' in described.text


@pytest.mark.parametrize('scene', scene_names())
def test_every_body_and_anchor_is_where_it_is(scene):
    simulator = Simulator(load_scene(scene), integrator='rk4')
    found, now = transforms(simulator), simulator.snapshot()
    assert set(found) == {f'dynsim/{member.name}' for member in (
        *simulator.scene.bodies, *simulator.scene.anchors)}
    for body in simulator.scene.bodies:
        transform, q = found[f'dynsim/{body.name}'], now.orientation(body.name)
        np.testing.assert_array_equal(xyz(transform.translation), now.position(body.name))
        np.testing.assert_array_equal(turn(transform), [1, 0, 0, 0] if q is None else q)
    for anchor in simulator.scene.anchors:
        transform = found[f'dynsim/{anchor.name}']
        np.testing.assert_array_equal(xyz(transform.translation), anchor.position)
        assert turn(transform) == [1, 0, 0, 0]


def test_they_follow_what_is_commanded():
    simulator = Simulator(load_scene('sphere_on_spring'), integrator='rk4')
    simulator.apply(MoveAnchor('hand', (0.1, 0.2, 2.3)))
    simulator.advance_tick()
    found = transforms(simulator)
    assert list(xyz(found['dynsim/hand'].translation)) == [0.1, 0.2, 2.3]
    np.testing.assert_array_equal(turn(found['dynsim/sphere']),
                                  simulator.snapshot().orientation('sphere'))


def test_two_nodes_have_frames_of_their_own():
    assert frame('/dynsim', 'sphere') == 'dynsim/sphere'
    assert frame('/lab/left/dynsim', 'sphere') == 'lab/left/dynsim/sphere'
