# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Rows come to a subscriber as they are, whichever way they are published."""

from all_listen import AllListen
from dynsim_ros.messages.scene_channels import scene_channels
from dynsim_ros.messages.tick_rows import TickRows
from dynsim_ros.ros import topics as topics_module
from dynsim_ros.ros.message_types import message_class
from dynsim_ros.ros.own_parameters import OWN
from dynsim_ros.ros.qos import profile
from dynsim_ros.ros.sending import OneByOne, Rcl, Sending, Together, Typed
from dynsim_ros.ros.topics import Topics
from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import Simulator
import pytest
import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.serialization import deserialize_message
from ros_client import Client

STAMP = 7_000_000_123


@pytest.fixture
def rows():
    simulator = Simulator(load_scene('sphere_on_spring'))
    simulator.advance_tick()
    rows = TickRows(scene_channels(simulator.scene, simulator.layout), simulator.layout)
    rows.fill(simulator.instant(), STAMP, rows.of())
    return rows


def pairs_of(rows, node):
    return [(i, node.create_publisher(message_class(channel.type_name), f'~/{channel.topic}',
                                      profile(channel.qos)))
            for i, channel in enumerate(rows.channels)]


def test_every_way_sends_what_the_rows_hold(node_here, rows):
    pairs = pairs_of(rows, node_here)
    client = Client()
    try:
        client.listen({channel.topic: channel.type_name for channel in rows.channels},
                      is_served=False)
        client.wait(lambda: all(publisher.get_subscription_count() for _, publisher in pairs))
        ways = Sending(rows).of(pairs), Sending(rows, False).of(pairs), OneByOne(rows, pairs)
        assert [type(send) for send in ways] == [Together, Typed, OneByOne]
        for send in ways:
            send()
            for i, channel in enumerate(rows.channels):
                client.wait(lambda topic=channel.topic: client.heard[topic])
                data = client.heard[channel.topic].pop()
                # Typed messages have other bytes where bytes mean nothing.
                assert (data == rows.message(i) if type(send) is not Typed else
                        deserialize_message(data, message_class(channel.type_name)) ==
                        deserialize_message(rows.message(i), message_class(channel.type_name)))
            assert not any(client.heard.values())
    finally:
        client.close()


def test_an_error_is_that_of_rclpy(node_here, rows):
    send = Sending(rows).of(pairs_of(rows, node_here))
    send()
    rclpy.shutdown()
    with pytest.raises(RCLError, match='context is invalid'):
        send()


def test_without_compiled_code_rclpy_publishes(node_here, rows, monkeypatch):
    monkeypatch.setattr('numba.config.DISABLE_JIT', 1)
    assert Rcl().publish is None
    assert type(Sending(rows).of(pairs_of(rows, node_here))) is OneByOne


def test_a_layout_that_is_not_that_of_ros_is_found_at_the_start(node_here, rows, monkeypatch):
    warnings = []
    monkeypatch.setattr(topics_module, 'layout_fault', lambda channels: 'sphere/pose: differs')
    monkeypatch.setattr(node_here, 'get_logger',
                        lambda: type('Log', (), {'warning': warnings.append}))
    simulator = Simulator(load_scene('sphere_on_spring'))
    topics = Topics(node_here, rows.channels, rows, AllListen(),
                    {name: own.default for name, own in OWN.items()})
    assert warnings == ['sphere/pose: differs']
    send = topics.schedule(simulator.settings.tick_ns, False).due(0).send
    assert type(send) is Typed
