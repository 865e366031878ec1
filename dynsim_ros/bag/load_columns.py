# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Structured arrays of messages taken apart into named columns and plain arrays."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np


def columns(values: np.ndarray) -> dict[str, np.ndarray]:
    """
    Return {dotted name: (n,) array} of structured messages (n,): 'pose.position.x', 'data.0'.

    An array whose layout names its elements, as the energies do, has columns of these names.
    """
    names = element_names(values)
    if names:
        return {name: values['data'][:, i] for i, name in enumerate(names)}
    return dict(_columns(values, ''))


def _columns(values: np.ndarray, name: str) -> Iterator[tuple[str, np.ndarray]]:
    if values.ndim > 1:
        for i in range(values.shape[1]):
            yield from _columns(values[:, i], f'{name}.{i}')
    elif values.dtype.char == 'S':
        yield name, np.char.decode(values, 'utf-8', 'replace')
    elif values.dtype.names is None:
        yield name, values
    else:
        for field in values.dtype.names:
            yield from _columns(values[field], f'{name}.{field}'.lstrip('.'))


def element_names(values: np.ndarray) -> list[str] | None:
    """Return the names of the elements of a std_msgs/Float64MultiArray as its label tells them."""
    if values.dtype.names != ('layout', 'data') or not len(values):
        return None
    dimensions = values['layout'][0]['dim']
    if len(dimensions) != 1:
        return None
    label = dimensions[0]['label'].decode(errors='replace')
    names = [name.strip() for name in label.partition('[')[0].split(',')]
    return names if len(set(names)) == len(names) == values['data'].shape[1] > 1 else None


def vectors(values: np.ndarray, names: str) -> np.ndarray:
    """Return (n, len(names)) float64 of the fields with these names of one letter."""
    return np.stack([values[name] for name in names], axis=-1).astype(float)
