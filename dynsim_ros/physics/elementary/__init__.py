# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Sine, cosine, exponential and arc tangent: within one unit of the last place, alike everywhere.

The C library's own are as exact, but their last bits depend on its version and on what the
processor can do. These are made of +, -, *, / in a fixed order, and of moving bits about. Their
polynomials are from test/reference/fit_polynomials.py.

Source: J.-M. Muller, Elementary Functions: Algorithms and Implementation (2016), chapters 10, 11.
"""

from .arc_tangent import arc_tangent, area_tangent
from .exponential import exponential
from .sine_cosine import sine_cosine

__all__ = ['arc_tangent', 'area_tangent', 'exponential', 'sine_cosine']
