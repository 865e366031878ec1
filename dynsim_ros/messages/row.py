# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A message of fixed size whose numbers a kernel fills in."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from .template import Template

# The leaves of a stamp and the letters of their types.
STAMP = {'header.stamp.sec': 'i', 'header.stamp.nanosec': 'I'}


@dataclass(frozen=True)
class Row:
    """
    A message of fixed size that a kernel fills in.

    template: its leaves are the stamp, if it has one, and those of `numbers`: {leaf: place of the
    number in Numbers}. Raises ValueError for a leaf that is no float64, or without a number.
    """

    template: Template
    numbers: Mapping[str, int]

    def __post_init__(self):
        """Check that every leaf is known and of the type that the kernel writes."""
        found = {leaf: place.code for leaf, place in self.template.places.items()}
        stamp = STAMP if STAMP.keys() & found.keys() else {}
        wanted = {**stamp, **dict.fromkeys(self.numbers, 'd')}
        if found != wanted:
            raise ValueError(f'{self.template.type_name}: its leaves are {found}, but '
                             f'{wanted} are filled in')
