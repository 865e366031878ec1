# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""ROS messages without ROS: definitions, CDR bytes, quality of service. Nothing imports rclpy."""
