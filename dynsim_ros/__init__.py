# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Simulate rigid bodies and particles on spring-dampers, with ROS 2 around it.

The rooms, each importing only from those after it: cli, ros, bag, messages, simulation,
integrators, physics, scene. Importing this package loads none of them.
"""

__version__ = '0.1.0'
