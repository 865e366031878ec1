# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Live nodes for tests of the node."""

from interfaces import can_be_had, standard_types
from live_fixtures import connect, discovery, start

__all__ = ['connect', 'discovery', 'standard_types', 'start']
# Of what they need there is no package: it has to be built.
collect_ignore = [] if can_be_had() else ['test_standard_services.py']
