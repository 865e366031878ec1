# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""ROS from start to shutdown, and a loop that serves a node."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
import os

import rclpy
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from .executor import new_executor

# Beyond it the UDP ports of a domain do not exist.
_LAST_DOMAIN = 232


@contextmanager
def ros_context(name: str, ros_args: Sequence[str]) -> Iterator[None]:
    """
    Start ROS with '--ros-args …' as on the command line, and shut it down at the end.

    Signals are left to the caller, so that what is being published and recorded is finished
    while ROS is still there. Raises ValueError for wrong ROS arguments.
    """
    _check_domain(os.environ.get('ROS_DOMAIN_ID', ''))
    try:
        rclpy.init(args=[name, *ros_args], signal_handler_options=SignalHandlerOptions.NO)
    except (RuntimeError, ValueError) as error:
        # rcl appends where in its own source the error arose.
        reason = one_line(error).split(', at /')[0]
        if 'ROSArgs' in type(error).__name__:
            raise ValueError(f'ROS does not understand {" ".join(ros_args)}: {reason}') from None
        raise ValueError(f'ROS cannot start: {reason}') from None
    try:
        yield
    finally:
        rclpy.try_shutdown()


def _check_domain(text: str):
    """Raise ValueError for a ROS_DOMAIN_ID that DDS cannot use: it would end the process."""
    if text and not (text.isdecimal() and int(text) <= _LAST_DOMAIN):
        raise ValueError(f"ROS_DOMAIN_ID: '{text}' is no domain; give a number from 0 to "
                         f'{_LAST_DOMAIN}')


@contextmanager
def spinning(node: Node) -> Iterator[Callable[[float], None]]:
    """Give a function that serves a node's callbacks for at most so many seconds, then returns."""
    executor = new_executor(node)

    def serve(seconds):
        try:
            executor.spin_once(timeout_sec=seconds)
        except (TypeError, ValueError) as error:
            # rclpy itself fails on requests such as a parameter of a type that does not exist.
            node.get_logger().error(f'a request was not understood, and dropped: {error}')

    try:
        yield serve
    finally:
        executor.remove_node(node)
        executor.shutdown()


def one_line(error: Exception) -> str:
    """Return an error's text without line breaks."""
    return ' '.join(str(error).split())
