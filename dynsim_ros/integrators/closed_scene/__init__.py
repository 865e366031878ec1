# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Which scenes move in closed form, as a whole, and their states at any time.

=====================================  ==========================================================
centres of mass                        condition
=====================================  ==========================================================
free flight of all bodies              no spring acts
a single body on springs               natural lengths 0, no dampers, to anchors, at its centre
a single body on the line of its       all that acts and moves is along that line, to the last
only spring, with damper               bit, and L stays above 1e-3 of its length for ever
everything at rest                     see equilibrium.py
=====================================  ==========================================================

=====================================  ==========================================================
rotations                              condition
=====================================  ==========================================================
about a fixed axis, with drag, whirl   spin, whirl and commanded torque are parallel, and the
and commanded torque                   inertia is scalar, or all is along a principal axis
about any axis, with the same          the inertia is scalar, and the air stops the spin within
                                       a turn or two
any rotation of any body               no moment acts on it
=====================================  ==========================================================
"""

from .equilibrium import comes_to_rest
from .evaluate import evaluate
from .motion import AT_REST
from .recognise import Recogniser

__all__ = ['AT_REST', 'Recogniser', 'comes_to_rest', 'evaluate']
