# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Which of rclpy's executors serves a node.

EventsExecutor answers in half the time that SingleThreadedExecutor takes, but is experimental: its
spin() was seen to run at full load and fire no timer. It is used after it has been tried.
"""

from functools import partial
import time

import rclpy
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.node import Node

try:
    from rclpy.experimental.events_executor import EventsExecutor
except ImportError:
    EventsExecutor = None

# The trial: a timer with this period has to fire twice in a time in which it could so often, and
# waiting for it may take so much of a processor's time [s].
_PERIOD, _LONGEST = 0.02, 1.0
_MOST_WORK = 0.008


def new_executor(node: Node, fast=EventsExecutor) -> Executor:
    """Return an executor that serves a node; fast: the one to be used if it works, or None."""
    problem = None if fast is None else _tried(fast, node.context)
    if problem is not None:
        node.get_logger().warning(f'{fast.__name__} {problem}; SingleThreadedExecutor is used')
    executor = SingleThreadedExecutor() if fast is None or problem is not None else fast()
    executor.add_node(node)
    return executor


def _tried(fast, context) -> str | None:
    """
    Return what is wrong with a kind of executor, in words, or None.

    It is tried with a node of its own, to which nobody has requests that would disturb the trial,
    or would be served before their time.
    """
    node = rclpy.create_node('_trial', context=context, use_global_arguments=False,
                             enable_rosout=False, start_parameter_services=False)
    executor = fast()
    executor.add_node(node)
    try:
        return _problem(executor, node)
    finally:
        executor.remove_node(node)
        executor.shutdown()
        node.destroy_node()


def _problem(executor: Executor, node: Node) -> str | None:
    """Return what is wrong with an executor, in words; None if it fires timers and can wait."""
    fired = []
    # Not a function in Python: a signal would raise its exception there, which rclpy reports.
    timer = node.create_timer(_PERIOD, partial(fired.append, True),
                              clock=Clock(clock_type=ClockType.STEADY_TIME))
    begin, used = time.monotonic(), time.thread_time()
    try:
        while len(fired) < 2:
            executor.spin_once(timeout_sec=2 * _PERIOD)
            if time.monotonic() > begin + _LONGEST:
                return f'fired {len(fired)} times in {_LONGEST:g} s a timer of {_PERIOD:g} s'
        if (work := time.thread_time() - used) > _MOST_WORK:
            return f'worked for {work * 1e3:.0f} ms while it was to wait'
        return None
    except RuntimeError as error:
        return f'fails: {error}'
    finally:
        node.destroy_timer(timer)
