# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""An executor that does not work is found out at the start, and another one is used."""

import time

from dynsim_ros.ros.executor import EventsExecutor, new_executor
import pytest
from rclpy.executors import SingleThreadedExecutor


class Deaf(SingleThreadedExecutor):
    """Fires no timer."""

    def spin_once(self, timeout_sec=None):
        """Wait, and do nothing."""
        time.sleep(timeout_sec)


class Broken(SingleThreadedExecutor):
    """Fails."""

    def spin_once(self, timeout_sec=None):
        """Raise an error."""
        raise RuntimeError('not supported')


class Restless(SingleThreadedExecutor):
    """Takes all of a processor while it waits."""

    def spin_once(self, timeout_sec=None):
        """Serve what is ready without ever waiting."""
        end = time.monotonic() + 0.02
        while time.monotonic() < end:
            super().spin_once(timeout_sec=0.0)


class Private(SingleThreadedExecutor):
    """Works; keeps the names of those whom it served."""

    served = set()

    def spin_once(self, timeout_sec=None):
        """Serve, and take note of whom."""
        self.served.update(node.get_name() for node in self.get_nodes())
        super().spin_once(timeout_sec=timeout_sec)


def kind_of(node, fast):
    executor = new_executor(node, fast)
    assert executor.get_nodes() == [node]
    executor.remove_node(node)
    executor.shutdown()
    return type(executor).__name__


def test_the_fast_one_works_here(node_here):
    assert kind_of(node_here, EventsExecutor) == 'EventsExecutor'


def test_requests_to_the_node_are_not_served_while_it_is_tried(node_here):
    assert kind_of(node_here, Private) == 'Private'
    assert Private.served and node_here.get_name() not in Private.served


@pytest.mark.parametrize('fast', [None, Deaf, Broken, Restless])
def test_what_does_not_work_is_not_used(node_here, fast):
    assert kind_of(node_here, fast) == 'SingleThreadedExecutor'
