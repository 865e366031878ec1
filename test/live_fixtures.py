# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Live nodes for tests, of which each module starts its own; and one in the test's own process."""

from live_node import LiveNode
import pytest
import rclpy
from rclpy.node import Node
from ros_client import Client
from tree import ROOT


@pytest.fixture(scope='module')
def discovery():
    """Let processes find each other in less than 1 s instead of up to 3 s."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('FASTRTPS_DEFAULT_PROFILES_FILE',
                     str(ROOT / 'config' / 'fastdds_one_machine.xml'))
        yield


@pytest.fixture(scope='module')
def start(discovery, tmp_path_factory):
    """Give a function that starts a node, which does not outlive the module."""
    started = []

    def start(*ros_args, folder=None, **options):
        folder = folder or tmp_path_factory.mktemp('node')
        node = LiveNode(folder, *ros_args, **options)
        started.append(node)
        return node

    yield start
    for node in started:
        node.kill()


@pytest.fixture(scope='module')
def connect(discovery):
    """Give a function that makes a client of a node, until the end of the module."""
    made = []

    def connect(node):
        client = Client(node.name, node.check)
        made.append(client)
        return client

    yield connect
    for client in made:
        client.close()


@pytest.fixture
def node_here(discovery):
    """Give a node in this process."""
    rclpy.init()
    node = Node('dynsim')
    yield node
    node.destroy_node()
    rclpy.try_shutdown()
