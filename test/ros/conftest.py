# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Live nodes for tests of the node."""

from interfaces import left_out, standard_types, tf2_types
from live_fixtures import connect, discovery, node_here, start

__all__ = ['connect', 'discovery', 'node_here', 'standard_types', 'start', 'tf2_types']
collect_ignore = left_out()
