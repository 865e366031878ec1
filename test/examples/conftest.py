# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Live nodes for the examples."""

from live_fixtures import connect, discovery, start

__all__ = ['connect', 'discovery', 'start']
