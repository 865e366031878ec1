# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The numbers of ticks, computed and written into rows of bytes by one compiled kernel."""
