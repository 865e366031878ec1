# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The Fast DDS profile for one machine, on the wire and between processes."""

import os
import socket
import struct
import time

from live_node import LiveNode
import pytest
from ros_listener import Listener
from tree import ROOT

VARIABLE = 'FASTRTPS_DEFAULT_PROFILES_FILE'
PROFILE = str(ROOT / 'config' / 'fastdds_one_machine.xml')
TOPIC = '/dynsim/sphere/pose'
# Of the DDS Interoperability Wire Protocol 2.5: parameters of an announcement (9.6.3) and the
# kind of locator that is UDPv4 (9.3.2).
USER_DATA, DISCOVERY = 0x31, 0x32
UDPV4 = 1


@pytest.fixture
def start(tmp_path):
    """Give a function that starts the node with or without the profile."""
    started = []

    def start(profile):
        with pytest.MonkeyPatch.context() as patch:
            if profile:
                patch.setenv(VARIABLE, PROFILE)
            started.append(LiveNode(tmp_path, '-p', 'rate:=50.0'))
        return started[-1]

    yield start
    for node in started:
        node.kill()


@pytest.fixture
def ear():
    """Give a socket where a participant of this domain would be: announcements come there."""
    port = 7400 + 250 * int(os.environ['ROS_DOMAIN_ID']) + 10 + 2 * 20
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ear:
        ear.bind(('127.0.0.1', port))
        ear.settimeout(30.0)
        yield ear


def announcement(ear):
    """Wait for an announcement; return its bytes."""
    packet, (sender, _) = ear.recvfrom(65536)
    assert (packet[:4], sender) == (b'RTPS', '127.0.0.1')
    return packet


def locators(packet, parameter):
    """Return [(kind, IPv4 address)] of the locators in an announcement."""
    mark = struct.pack('<HH', parameter, 24)
    return [(struct.unpack('<i', part[:4])[0], '.'.join(map(str, part[20:24])))
            for part in packet.split(mark)[1:]]


def test_announcements_come_five_times_a_second(start, ear):
    node = start(profile=True)
    times = []
    while len(times) < 40:
        announcement(ear)
        times.append(time.monotonic())
    # without the profile as many take 2 minutes
    assert times[-1] - times[0] < 40.0
    # what it does not understand Fast DDS says
    assert 'XMLPARSER' not in node.stop()


def test_messages_are_asked_for_by_udp_on_loopback_alone(start, ear):
    start(profile=True)
    packet = announcement(ear)
    assert locators(packet, USER_DATA) == [(UDPV4, '127.0.0.1')]
    assert {kind for kind, _ in locators(packet, DISCOVERY)} == {UDPV4}


@pytest.mark.parametrize('listener_has_it', [True, False])
@pytest.mark.parametrize('node_has_it', [True, False])
def test_processes_with_and_without_it_find_each_other(start, node_has_it, listener_has_it):
    node = start(node_has_it)
    with pytest.MonkeyPatch.context() as patch:
        if listener_has_it:
            patch.setenv(VARIABLE, PROFILE)
        listener = Listener(f'{TOPIC}=geometry_msgs/msg/PoseStamped')
    try:
        assert len(listener.wait(5, timeout=30.0)) >= 5
    finally:
        listener.close()
    node.check()
