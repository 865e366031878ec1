# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Definitions of messages as bags carry them: nothing of the types has to be installed."""

from __future__ import annotations

from collections.abc import Callable
import re

from .definitions import Field, installed_fields, parse_fields

_SEPARATION = re.compile(r'^=+\r?\nMSG: ', re.MULTILINE)


def recorded_fields(type_name: str, text: str) -> Callable[[str], tuple[Field, ...]]:
    """
    Return what gives the fields of a type, and of those nested in it, by its name.

    text: as in MessageDefinition. A type that it lacks, or all where it is empty, is looked for
    among those installed. Raises MessageDefinitionError.
    """
    main, *nested = _SEPARATION.split(text)
    found = {type_name: parse_fields(type_name, main, 'the bag')} if text.strip() else {}
    for part in nested:
        name, _, body = part.partition('\n')
        package, _, short = name.strip().partition('/')
        full = f'{package}/msg/{short.removeprefix("msg/")}'
        found[full] = parse_fields(full, body, 'the bag')
    return lambda name: found[name] if name in found else installed_fields(name)
