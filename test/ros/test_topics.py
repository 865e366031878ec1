# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Names, types, frames, stamps, bytes and quality of service of what a node publishes."""

from dynsim_ros.scene import load_scene
import numpy as np
import pytest
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from rclpy.serialization import deserialize_message, serialize_message
from ros_client import LATCHED, nanoseconds, stamps, type_named
from scene_topics import (
    body,
    BOX,
    DIAGNOSTICS,
    EPOCH,
    forces,
    HASH,
    MARKERS,
    NUMBERS,
    PARTICLE,
    POSE,
    SPHERE,
    torques,
)
from std_srvs.srv import SetBool

TICK = 10_000_000
# the last where tf2_msgs is installed
OTHERS_HAVE_THEM = {'/rosout', '/parameter_events', '/diagnostics', '/tf'}
OF_EVERY_SCENE = {'epoch': EPOCH, 'state_hash': HASH}
OF_ANCHORS = {'handles/update': 'visualization_msgs/msg/InteractiveMarkerUpdate'}


@pytest.fixture(scope='module')
def node(start):
    return start()


@pytest.fixture(scope='module')
def client(node, connect):
    client = connect(node)
    client.listen({**SPHERE, '/diagnostics': DIAGNOSTICS})
    client.more('sphere/pose', 60)
    client.wait(lambda: client.heard['/diagnostics'])
    client.pause()
    client.drain()
    return client


def offered(client, name):
    """Return {topic: type name} of the publishers of a node, relative where they can be."""
    namespace, _, last = name.rpartition('/')
    found = client.node.get_publisher_names_and_types_by_node(last, namespace or '/')
    return {topic.removeprefix(f'{name}/'): types[0] for topic, types in found}


def test_topics_and_types(node, client):
    assert {topic: kind for topic, kind in offered(client, node.name).items()
            if topic not in OTHERS_HAVE_THEM} == {**SPHERE, **OF_EVERY_SCENE, **OF_ANCHORS}


def test_commands_and_services(client):
    of_node = client.node.get_subscriber_names_and_types_by_node('dynsim', '/')
    assert dict(of_node) == {
        '/dynsim/hand/command': ['geometry_msgs/msg/PointStamped'],
        '/dynsim/handles/feedback': ['visualization_msgs/msg/InteractiveMarkerFeedback'],
        '/dynsim/sphere/wrench_command': ['geometry_msgs/msg/WrenchStamped'],
        '/dynsim/parameter_command': ['rcl_interfaces/msg/Parameter']}
    services = dict(client.node.get_service_names_and_types_by_node('dynsim', '/'))
    assert {name: kinds for name, kinds in services.items() if 'std_srvs' in kinds[0]} == {
        '/dynsim/pause': ['std_srvs/srv/SetBool'], '/dynsim/record': ['std_srvs/srv/SetBool'],
        **{f'/dynsim/{name}': ['std_srvs/srv/Trigger'] for name in (
            'step', 'step_until', 'reset', 'save_state', 'load_state', 'rewind')}}


@pytest.mark.parametrize('topic', [topic for topic in SPHERE if topic not in ('energy',
                                                                              'markers')])
def test_stamps_are_one_tick_apart_in_the_world_frame(client, topic):
    messages = client.messages(topic)
    assert {message.header.frame_id for message in messages} == {'world'}
    times = stamps(messages)
    assert times == list(range(times[0], times[0] + len(times) * TICK, TICK))
    assert times[0] % TICK == 0 and len(times) >= 59


def test_all_topics_of_a_tick_have_one_stamp(client):
    last = {nanoseconds(client.last(topic).header.stamp) for topic in SPHERE
            if topic not in ('energy', 'markers')}
    assert len(last) == 1


def test_energy_comes_every_tick(client):
    poses = len(client.heard['sphere/pose'])
    assert abs(len(client.heard['energy']) - poses) <= 1
    energy = client.last('energy')
    assert energy.layout.dim[0].label == (
        'kinetic, gravitational, spring, total, work_damper, work_air, work_anchor, work_push, '
        'imbalance [J]')
    kinetic, gravitational, spring, total, *_ = energy.data
    assert total == pytest.approx(kinetic + gravitational + spring, rel=1e-15)


def test_offered_quality_of_service(client):
    for topic in SPHERE:
        (info,) = client.node.get_publishers_info_by_topic(client.full(topic))
        assert info.qos_profile.reliability == ReliabilityPolicy.RELIABLE
        assert info.qos_profile.durability == DurabilityPolicy.VOLATILE
    (epoch,) = client.node.get_publishers_info_by_topic(client.full('epoch'))
    assert epoch.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL


def test_the_epoch_is_told_to_those_who_come_late(client):
    client.listen({'epoch': EPOCH}, LATCHED)
    client.wait(lambda: client.heard['epoch'])
    assert client.last('epoch').data == 0


@pytest.mark.parametrize('topic', [*SPHERE, '/diagnostics'])
def test_bytes_are_those_of_ros(client, topic):
    kind = type_named({**SPHERE, '/diagnostics': DIAGNOSTICS}[topic])
    for data in client.heard[topic][:3]:
        message = deserialize_message(data, kind)
        theirs = serialize_message(message)
        # at the end there may be zeros up to a multiple of four
        assert abs(len(theirs) - len(data)) < 4
        for i in (i for i, (ours, other) in enumerate(zip(data, theirs)) if ours != other):
            # ROS leaves in its padding whatever was there: bytes that mean nothing
            other = data[:i] + bytes([data[i] ^ 0xff]) + data[i + 1:]
            assert (data[i], deserialize_message(other, kind)) == (0, message)


def test_all_numbers_are_finite(client):
    for topic in ('sphere/wrench/net', 'sphere/wrench/air'):
        assert np.isfinite(forces(client.messages(topic))).all()


OTHERS = {
    'particle_on_spring': PARTICLE,
    'spinning_box': BOX,
    'falling_in_wind': {**body('ball', 'air', 'gravity'), 'energy': NUMBERS, 'markers': MARKERS},
    'double_pendulum_of_spheres': {
        **body('upper', 'spring', 'damper', 'air', 'gravity'),
        **body('lower', 'spring', 'damper', 'air', 'gravity'), 'ceiling/pose': POSE,
        'energy': NUMBERS, 'markers': MARKERS},
}


@pytest.fixture(scope='module')
def others(start):
    return {scene: start('-p', f'scene:={scene}', '-p', 'integrator:=rk4',
                         '-r', f'__ns:=/{scene}', name=f'/{scene}/dynsim') for scene in OTHERS}


@pytest.mark.parametrize('scene', OTHERS)
def test_only_what_a_scene_has(others, client, scene):
    name = others[scene].name
    client.wait(lambda: ('dynsim', f'/{scene}') in client.node.get_node_names_and_namespaces())
    client.wait(lambda: 'epoch' in offered(client, name))
    client.wait(client.node.create_client(SetBool, f'{name}/pause').service_is_ready)
    assert {topic: kind for topic, kind in offered(client, name).items()
            if topic not in OTHERS_HAVE_THEM} == {
                **OTHERS[scene], **OF_EVERY_SCENE,
                **(OF_ANCHORS if load_scene(scene).anchors else {})}


def test_a_particle_knows_no_torque(others, connect):
    client = connect(others['particle_on_spring'])
    client.listen(PARTICLE)
    client.more('particle/wrench/net', 20)
    client.pause()
    client.drain()
    for kind in ('spring', 'gravity', 'net'):
        messages = client.messages(f'particle/wrench/{kind}')
        assert np.abs(forces(messages)).max() > 1.0
        assert not torques(messages).any()
    assert not client.last('particle/twist').twist.angular.z
    for marker in client.last('markers').markers:
        assert marker.ns in ('bodies', 'anchors', 'springs')
