# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Definitions of ROS messages, found in the share folders of the ROS on this machine.

Those that bags hold but ROS on PyPI lacks are shipped with this package.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
import json
import os
from pathlib import Path
import re
import sys
from typing import Any

from rosidl_adapter import parser

_TYPE_NAME = re.compile(r'([a-z][a-z0-9_]*)/msg/([A-Z][A-Za-z0-9]*)')
_SEPARATOR = '=' * 80
_SHIPPED = Path(__file__).parent / 'shipped'


class MessageDefinitionError(ValueError):
    """A message type is misspelt, not installed, or its definition cannot be read."""


@dataclass(frozen=True)
class Field:
    """
    One field of a message.

    type_name: a primitive ('float64', 'string', …) or a message type ('geometry_msgs/msg/Point').
    length: None for a single value or a sequence, else the length of a fixed array.
    bound: longest sequence allowed, None for no bound. default: as the definition gives it.
    """

    name: str
    type_name: str
    is_sequence: bool = False
    length: int | None = None
    bound: int | None = None
    default: Any = None

    @property
    def is_message(self) -> bool:
        """Tell a nested message from a primitive."""
        return '/' in self.type_name


@dataclass(frozen=True)
class MessageDefinition:
    """
    A message type as it is installed here.

    text: the .msg file with every nested definition appended, as MCAP's `ros2msg` wants it.
    type_hash: 'RIHS01_…', or '' where the installation has none. fields: in wire order.
    """

    type_name: str
    text: str
    type_hash: str
    fields: tuple[Field, ...]


@cache
def definition(type_name: str) -> MessageDefinition:
    """
    Return the definition of a type such as 'geometry_msgs/msg/PoseStamped'.

    Looks in every prefix of AMENT_PREFIX_PATH, in sys.prefix, above the message's Python
    package, and among those shipped. Raises MessageDefinitionError, in one line, for a type that
    is not there.
    """
    path = _msg_file(type_name)
    text, fields = _read(type_name, path)
    parts = [text]
    for nested in _nested_types(fields, [type_name])[1:]:
        package, _, name = nested.split('/')
        parts.append(f'{_SEPARATOR}\nMSG: {package}/{name}\n{_read(nested, _msg_file(nested))[0]}')
    return MessageDefinition(type_name, '\n'.join(parts), _type_hash(path, type_name), fields)


def installed_fields(type_name: str) -> tuple[Field, ...]:
    """Return the fields of a type as it is installed here."""
    return definition(type_name).fields


def _msg_file(type_name: str) -> Path:
    """Return the .msg file of a type, or raise an error that says where it was looked for."""
    match = _TYPE_NAME.fullmatch(type_name)
    if match is None:
        raise MessageDefinitionError(
            f"'{type_name}' is not a message type: write package/msg/Name, "
            'for example geometry_msgs/msg/PoseStamped')
    package, name = match.groups()
    prefixes = _prefixes(package)
    for prefix in prefixes:
        path = prefix / 'share' / package / 'msg' / f'{name}.msg'
        if path.is_file():
            return path
    raise MessageDefinitionError(
        f"no definition of '{type_name}' in {', '.join(map(str, prefixes))}: install "
        f"ros-jazzy-{package.replace('_', '-')} or source the workspace that has it")


def _prefixes(package: str) -> list[Path]:
    """Return the installation prefixes to look in, in order, each once."""
    prefixes = [Path(entry) for entry in os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep)
                if entry]
    prefixes.append(Path(sys.prefix))
    spec = find_spec(package)
    for folder in (spec.submodule_search_locations or ()) if spec else ():
        prefixes += [parent for parent in Path(folder).parents
                     if (parent / 'share' / package).is_dir()]
    return list(dict.fromkeys([*prefixes, _SHIPPED]))


@cache
def _read(type_name: str, path: Path) -> tuple[str, tuple[Field, ...]]:
    """Return a .msg file's text and its fields."""
    try:
        text = path.read_text(encoding='utf-8')
    except (OSError, UnicodeDecodeError) as error:
        raise MessageDefinitionError(
            f"the definition of '{type_name}' in {path} cannot be read: {error}") from None
    return text, parse_fields(type_name, text, str(path))


def parse_fields(type_name: str, text: str, origin: str) -> tuple[Field, ...]:
    """Return the fields that the text of a .msg file declares; origin: where it stands."""
    package, _, name = type_name.split('/')
    try:
        return tuple(map(_field, parser.parse_message_string(package, name, text).fields))
    except (ValueError, TypeError, NameError, parser.InvalidSpecification,
            parser.InvalidValue) as error:
        raise MessageDefinitionError(
            f"the definition of '{type_name}' in {origin} cannot be read: {error}") from None


def _field(parsed: parser.Field) -> Field:
    """Turn the parser's field into ours."""
    kind = parsed.type
    fixed = kind.is_array and bool(kind.array_size) and not kind.is_upper_bound
    return Field(
        name=parsed.name,
        type_name=f'{kind.pkg_name}/msg/{kind.type}' if kind.pkg_name else kind.type,
        is_sequence=kind.is_array and not fixed,
        length=kind.array_size if fixed else None,
        bound=kind.array_size if kind.is_upper_bound else None,
        default=parsed.default_value)


def _nested_types(fields: tuple[Field, ...], found: list[str]) -> list[str]:
    """Append the types that the fields are made of to `found`, each once, and return it."""
    for field in fields:
        if field.is_message and field.type_name not in found:
            found.append(field.type_name)
            _nested_types(_read(field.type_name, _msg_file(field.type_name))[1], found)
    return found


def _type_hash(path: Path, type_name: str) -> str:
    """Return the type's hash out of the .json beside the .msg, '' where there is none."""
    try:
        described = json.loads(path.with_suffix('.json').read_text(encoding='utf-8'))
        return next(entry['hash_string'] for entry in described['type_hashes']
                    if entry['type_name'] == type_name)
    except (OSError, ValueError, KeyError, TypeError, StopIteration):
        return ''
