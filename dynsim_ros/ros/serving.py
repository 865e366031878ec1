# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A node whose services are answered by a thread, while the main thread does the work."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
import threading

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

# How long the thread may take to see that it is to end, in s.
_PERIOD = 0.1


@contextmanager
def serving(name: str, ros_args: Sequence[str]) -> Iterator[Node]:
    """
    Give a node that answers services until the block is left, then shut ROS down.

    ros_args: '--ros-args …' as on the command line. Signals are left to the caller, so that the
    node can still finish what it publishes. Raises ValueError for wrong ROS arguments.
    """
    try:
        rclpy.init(args=[name, *ros_args], signal_handler_options=SignalHandlerOptions.NO)
        node = Node(name)
    except (RuntimeError, ValueError) as error:
        rclpy.try_shutdown()
        # rcl appends the place in its own source to each message.
        reason = ' '.join(str(error).split(', at /')[0].split())
        raise ValueError(
            f"ROS does not start with the arguments '{' '.join(ros_args)}': {reason}") from None
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    ended = threading.Event()

    def serve():
        while not ended.is_set():
            try:
                executor.spin_once(timeout_sec=_PERIOD)
            except ExternalShutdownException:
                return

    thread = threading.Thread(target=serve, name='services', daemon=True)
    thread.start()
    try:
        yield node
    finally:
        ended.set()
        executor.wake()
        thread.join()
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()
