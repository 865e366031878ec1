# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Units with a prefix, so that numbers with few digits say enough."""

import math

_PREFIXES = {-15: 'f', -12: 'p', -9: 'n', -6: 'µ', -3: 'm', 0: '', 3: 'k', 6: 'M', 9: 'G'}


def prefixed(unit, largest):
    """
    Return (unit with a prefix, what to multiply numbers by) for numbers up to a size.

    A unit that is '' has no prefix. The largest number becomes one from 1 to 1000.
    """
    if not unit or not 0.0 < largest < math.inf:
        return unit, 1.0
    power = min(max(3 * math.floor(math.log10(largest) / 3), -15), 9)
    return _PREFIXES[power] + unit, 10.0 ** -power
