# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The part of a command line that belongs to ROS."""

from __future__ import annotations

from collections.abc import Sequence


def split(args: Sequence[str]) -> tuple[list[str], list[str]]:
    """Return our arguments and those for ROS: from --ros-args to the end or to a lone --."""
    own, ros_args = [], []
    target = own
    for argument in args:
        if argument == '--ros-args':
            target = ros_args
        target.append(argument)
        if argument == '--' and target is ros_args:
            target = own
    return own, ros_args
