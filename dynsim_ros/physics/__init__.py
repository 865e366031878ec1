# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The formulas of the dynamics, and what the integrators need of them, compiled."""
