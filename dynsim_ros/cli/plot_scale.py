# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How far an axis reaches, and in which unit."""

from __future__ import annotations

from collections.abc import Iterable
import math

import numpy as np

_PREFIXES = {-24: 'y', -21: 'z', -18: 'a', -15: 'f', -12: 'p', -9: 'n', -6: 'µ', -3: 'm',
             3: 'k', 6: 'M', 9: 'G', 12: 'T'}
# Numbers of this size are written without a prefix.
_PLAIN = 0.02, 2e4
# What changes by less, as a share of its size, is drawn as if constant; room at both ends.
_CONSTANT, _ROOM = 1e-3, 0.06


def limits(curves: Iterable[np.ndarray]) -> tuple[float, float, float]:
    """Return where an axis for some curves begins and ends, and the largest size of a value."""
    finite = [curve[np.isfinite(curve)] for curve in curves]
    values = np.concatenate([(part.min(), part.max()) for part in finite if len(part)] or [(0.0,)])
    low, high = float(values.min()), float(values.max())
    largest = max(-low, high)
    if largest == 0.0:
        return -1.0, 1.0, 0.0
    if high - low < _CONSTANT * largest:
        middle, half = 0.5 * (low + high), 0.1 * largest
        return middle - half, middle + half, largest
    room = _ROOM * (high - low)
    return low - room, high + room, largest


def prefixed(unit: str, largest: float) -> tuple[str, float]:
    """Return a unit with the SI prefix that suits the largest value, and what that stands for."""
    if not unit or largest == 0.0 or _PLAIN[0] <= largest < _PLAIN[1]:
        return unit, 1.0
    exponent = 3 * math.floor(math.log10(largest) / 3)
    if exponent not in _PREFIXES:
        return unit, 1.0
    return _PREFIXES[exponent] + unit, 10.0 ** exponent
