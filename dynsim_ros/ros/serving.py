# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A node whose services are answered by a thread, while the main thread does the work."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
import threading

from rclpy.node import Node

from .context import one_line, ros_context, spinning

# How long the thread may take to see that it is to end, in s.
_PERIOD = 0.1


@contextmanager
def serving(name: str, ros_args: Sequence[str]) -> Iterator[Node]:
    """
    Give a node that answers services until the block is left, then shut ROS down.

    ros_args: '--ros-args …' as on the command line. Signals are left to the caller, so that the
    node can still finish what it publishes. Raises ValueError for wrong ROS arguments.
    """
    with ros_context(name, ros_args):
        try:
            node = Node(name)
        except (RuntimeError, ValueError) as error:
            raise ValueError(f'ROS cannot start: {one_line(error)}') from None
        try:
            with spinning(node) as serve, _thread(serve):
                yield node
        finally:
            node.destroy_node()


@contextmanager
def _thread(serve) -> Iterator[None]:
    """Serve in a thread until the block is left."""
    ended = threading.Event()

    def run():
        while not ended.is_set():
            serve(_PERIOD)

    thread = threading.Thread(target=run, name='services', daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()
