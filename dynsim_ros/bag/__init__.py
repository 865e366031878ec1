# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bags: recordings as MCAP files, written and read without ROS. Nothing imports rclpy."""
