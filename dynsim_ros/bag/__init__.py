# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bags: recordings as MCAP files, written and read without ROS. Nothing imports rclpy."""

__all__ = ['load']


def load(path, topics=None, start=None, end=None):
    """
    Return a bag as a LoadedRun: {topic: structured numpy array}, with all that it tells of a run.

    path: an MCAP file, of this package or any other, or the folder of a rosbag2 recording.
    topics: names, or patterns with * and ?, of what is to be loaded, None for all; start, end:
    first and last time wanted [s], both included, None for all. Of a file that is cut off what is
    intact is loaded, see its `problem`. Raises BagError, in one line, for what is no bag.
    """
    # Imported here: who only writes or plays bags needs none of it.
    from .load_run import LoadedRun

    return LoadedRun(path, topics, start, end)
