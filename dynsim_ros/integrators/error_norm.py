# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
How large an error is.

Of each body, the errors of position [m], velocity [m/s], orientation (quaternion) and angular
velocity [rad/s], each over max(1, size of that part), the size being its largest component; the
norm is the largest of these.
"""

import math

from ..physics.jit import formula
from ..physics.state import omega_at, quaternion_at


@formula
def part_error(first, count, y, error):
    """Return the error of the part y[first] to y[first + count - 1]; infinite if not finite."""
    size, largest = 1.0, 0.0
    for i in range(first, first + count):
        size = max(size, abs(y[i]))
        e = abs(error[i])
        if not e < math.inf:
            return math.inf
        largest = max(largest, e)
    return largest * (1.0 / size)


@formula
def error_norm(bodies, rigid, y, error):
    """Return the norm of an error; y and error: Cells, laid out as the state."""
    largest = 0.0
    for i in range(0, quaternion_at(bodies), 3):
        largest = max(largest, part_error(i, 3, y, error))
    for i in range(quaternion_at(bodies), omega_at(bodies, rigid), 4):
        largest = max(largest, part_error(i, 4, y, error))
    for i in range(omega_at(bodies, rigid), omega_at(bodies, rigid) + 3 * rigid, 3):
        largest = max(largest, part_error(i, 3, y, error))
    return largest
