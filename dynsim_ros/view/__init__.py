# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A run shown in the browser: recorded or live, in 3-D and as plots."""
