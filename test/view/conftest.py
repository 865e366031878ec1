# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests of the viewer share."""

from live_fixtures import connect, discovery, start
from view_fixtures import bag, view

__all__ = ['bag', 'connect', 'discovery', 'start', 'view']
