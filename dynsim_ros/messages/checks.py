# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Checks of nested dicts and sequences against message definitions; errors name the field."""

from __future__ import annotations

from collections.abc import Mapping

from .definitions import definition, Field


def fields_for(type_name: str, value, path: str) -> tuple[Field, ...]:
    """Return the fields of a message type after checking that `value` is a dict of such."""
    fields = definition(type_name).fields
    if not isinstance(value, Mapping):
        raise ValueError(f'{path}: {value!r} is not a dict of fields')
    unknown = value.keys() - {field.name for field in fields}
    if unknown:
        raise ValueError(f"{path} has no field '{min(unknown)}': its fields are "
                         + ', '.join(field.name for field in fields))
    return fields


def check_elements(field: Field, value, path: str):
    """Raise ValueError unless `value` is a sequence that fits the array or sequence field."""
    if isinstance(value, (str, Mapping)) or not hasattr(value, '__len__'):
        raise ValueError(f'{path}: {value!r} is not a sequence')
    if field.length not in (None, len(value)):
        raise ValueError(f'{path}: {len(value)} elements where {field.length} are needed')
    if field.bound is not None and len(value) > field.bound:
        raise ValueError(f'{path}: {len(value)} elements, at most {field.bound} are allowed')
