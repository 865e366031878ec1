# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Rows of structured arrays as messages."""

import numpy as np


def plain(value):
    """Return a value of a structured array as nested dicts and lists, as cdr.decode does."""
    if isinstance(value, np.void):
        if value.dtype.names and value.dtype.names[0] == '0':
            return [plain(value[name]) for name in value.dtype.names]
        return {name: plain(value[name]) for name in value.dtype.names or ()}
    if isinstance(value, np.ndarray):
        return value.tobytes() if value.dtype == np.uint8 else [plain(part) for part in value]
    return value.decode() if isinstance(value, bytes) else value.item()
