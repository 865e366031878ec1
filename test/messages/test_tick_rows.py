# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Rows of ticks, byte for byte what rclpy makes of the same messages."""

from dataclasses import replace
import gc
import tracemalloc

from by_hand import nothing_compiled
from dynsim_ros.messages import scene_channels as channels_module
from dynsim_ros.messages.cdr import decode
from dynsim_ros.messages.channel import Channel
from dynsim_ros.messages.row import Row
from dynsim_ros.messages.scene_channels import scene_channels
from dynsim_ros.messages.template import Place, Template
from dynsim_ros.messages.tick_rows import TickRows
from dynsim_ros.ros.layout_check import layout_fault, typed_message
from dynsim_ros.ros.message_types import message_class
from dynsim_ros.scene import load_scene, scene_names
from dynsim_ros.simulation import MoveAnchor, PushBody, Simulator
import numpy as np
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from scene_topics import xyz

STAMP = 7_000_000_123


def rows_of(simulator, channels=None):
    channels = channels or scene_channels(simulator.scene, simulator.layout)
    return TickRows(channels, simulator.layout)


def same_but_for_padding(data, message, template):
    """Tell whether bytes are rclpy's serialisation of a message, where they mean something."""
    theirs, padding = serialize_message(message), set(template.padding)
    return len(data) <= len(theirs) and all(
        data[i] == theirs[i] for i in range(template.size) if i not in padding)


def expected(channel, now):
    """Return rclpy's message of a topic for a Snapshot."""
    message, (name, kind, *wrench) = message_class(channel.type_name)(), (
        *channel.topic.split('/'), '')[:3]
    if channel.topic == 'energy':
        energy = now.energy
        message.layout.dim = deserialize_message(b'\0\1\0\0' + bytes(32), type(message)).layout.dim
        message.data = [energy.kinetic, energy.gravitational, energy.spring, energy.total,
                        *energy.work.values(), energy.imbalance]
        return message
    message.header.frame_id = 'world'
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(STAMP, 10 ** 9)
    if kind == 'twist':
        put(message.twist.linear, now.velocity(name))
        put(message.twist.angular, now.angular_velocity(name))
    elif kind == 'wrench':
        force, torque = now.wrench(wrench[0], name)
        put(message.wrench.force, force)
        put(message.wrench.torque, torque)
    elif name in now.layout.anchors:
        put(message.pose.position, now.anchor_position(name))
    else:
        put(message.pose.position, now.position(name))
        turned = message.pose.orientation
        if (q := now.orientation(name)) is not None:
            turned.w, turned.x, turned.y, turned.z = map(float, q)
    return message


def put(vector, values):
    if values is not None:
        vector.x, vector.y, vector.z = map(float, values)


@pytest.mark.parametrize('name', scene_names())
def test_rows_are_what_rclpy_serialises(name):
    simulator = Simulator(load_scene(name), anchor_interpolation='linear')
    with nothing_compiled():
        simulator.advance_tick()
        for anchor in simulator.layout.anchors[:1]:
            simulator.apply(MoveAnchor(anchor, (0.1, 0.2, 1.9)))
        simulator.apply(PushBody(simulator.layout.bodies[0], (1.0, 2.0, 3.0), (0.0, 0.0, 0.0)))
        simulator.advance_tick()
    rows, now = rows_of(simulator), simulator.snapshot()
    rows.fill(simulator.instant(), STAMP, rows.of())
    for i, channel in enumerate(rows.channels):
        data, message = rows.message(i), expected(channel, now)
        if channel.topic == 'energy':
            assert list(deserialize_message(data, type(message)).data) == list(message.data)
        else:
            assert same_but_for_padding(data, message, channel.row.template), channel.topic


@pytest.mark.parametrize('length', range(71))
def test_frame_names_of_every_length(length, monkeypatch):
    monkeypatch.setattr(channels_module, 'WORLD', 'f' * length)
    simulator = Simulator(load_scene('sphere_on_spring'))
    channels = scene_channels(simulator.scene, simulator.layout)
    assert layout_fault(channels) is None
    rows = rows_of(simulator, channels)
    rows.fill(simulator.instant(), STAMP, rows.of())
    for i, channel in enumerate(rows.channels):
        data, template = rows.message(i), channel.row.template
        message = typed_message(channel.type_name, decode(channel.type_name, data))
        assert len(data) % 4 == 0 and same_but_for_padding(data, message, template)
        if channel.topic == 'sphere/pose':
            assert message.header.frame_id == 'f' * length
            np.testing.assert_array_equal(xyz(message.pose.position),
                                          simulator.snapshot().position('sphere'))


@pytest.mark.timeout(300)  # compiles first
def test_many_ticks_at_once_are_the_same_bytes():
    simulator = Simulator(load_scene('two_anchors'), anchor_interpolation='linear')
    simulator.advance_tick()
    simulator.apply(MoveAnchor(simulator.layout.anchors[0], (0.1, 0.2, 1.9)))
    rows, tick_ns = rows_of(simulator), simulator.settings.tick_ns
    first, states, blocks = simulator.instant(), [], []
    for k in range(5):
        instant = simulator.instant()
        states.append(instant.states[0].copy())
        rows.fill(instant, STAMP + k * tick_ns, rows.of())
        blocks.append(rows.block.copy())
        simulator.advance_tick()
    rows.fill(first._replace(states=np.array(states), period_ns=tick_ns), STAMP, rows.of())
    np.testing.assert_array_equal(rows.blocks, blocks)
    np.testing.assert_array_equal(rows.block, blocks[-1])


def test_only_what_is_wanted_is_written():
    simulator = Simulator(load_scene('sphere_on_spring'))
    rows = rows_of(simulator)
    poses = rows.of(channel for channel in rows.channels if channel.topic.endswith('pose'))
    assert not poses.with_forces and not poses.with_energies
    assert rows.of(rows.channels[2:3]).with_forces and rows.of(rows.channels[-1:]).with_energies
    rows.fill(simulator.instant(), STAMP, poses)
    written = [i for i in range(len(rows.channels)) if any(rows.message(i)[-8:])]
    assert written == list(poses.numbers) == [0, 7]
    assert [int(rows.block[start]) for start in rows.table.start] == [
        5 if i in poses.numbers else 0 for i in range(len(rows.channels))]


def test_filling_keeps_no_memory():
    simulator = Simulator(load_scene('sphere_on_spring'))
    rows = rows_of(simulator)
    instant, wanted = simulator.instant(), rows.of()
    rows.fill(instant, STAMP, wanted)
    tracemalloc.start()
    try:
        gc.collect()
        before = tracemalloc.get_traced_memory()[0]
        for _ in range(10_000):
            rows.fill(instant, STAMP, rows.of())
            rows.message(3)
        gc.collect()
        assert tracemalloc.get_traced_memory()[0] - before < 10_000
    finally:
        tracemalloc.stop()


def test_a_wrong_layout_is_found_and_typed_messages_are_right():
    simulator = Simulator(load_scene('sphere_on_spring'))
    channels = scene_channels(simulator.scene, simulator.layout)
    assert layout_fault(channels) is None
    template = channels[0].row.template
    places = dict(template.places)
    x, y = 'pose.position.x', 'pose.position.y'
    places[x], places[y] = places[y], places[x]
    swapped = replace_template(template, places=places)
    assert layout_fault([with_template(channels[0], swapped)]) == (
        'sphere/pose: ROS lays geometry_msgs/msg/PoseStamped out differently from byte 28 on: '
        'typed messages are published instead')
    shifted = replace_template(template, places={
        leaf: Place(place.start + 4, place.code) for leaf, place in template.places.items()})
    assert 'is beyond the' in layout_fault([with_template(channels[0], shifted)])
    rows = rows_of(simulator)
    rows.fill(simulator.instant(), STAMP, rows.of())
    typed = typed_message(channels[0].type_name, decode(channels[0].type_name, rows.message(0)))
    assert same_but_for_padding(rows.message(0), typed, template)


def replace_template(template, **attributes):
    other = Template.__new__(Template)
    other.__dict__.update(template.__dict__, **attributes)
    return other


def with_template(channel, template):
    return replace(channel, row=Row(template, channel.row.numbers))


def test_what_cannot_be_filled_in_is_refused():
    template = Template('geometry_msgs/msg/PointStamped')
    with pytest.raises(ValueError, match='PointStamped: its leaves are'):
        Row(template, {'point.x': 0, 'point.y': 1})
    with pytest.raises(ValueError, match='UInt64'):
        Channel('a', 'std_msgs/msg/UInt64', None, row=Row(Template('std_msgs/msg/UInt64'),
                                                          {'data': 0}))
