# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The Python class of a message type, by its name."""

from importlib import import_module
from importlib.util import find_spec


def message_class(type_name):
    """Return the class of 'package/msg/Name'; raise ImportError or AttributeError."""
    package, folder, name = type_name.split('/')
    return getattr(import_module(f'{package}.{folder}'), name)


def has_message_class(type_name):
    """Tell whether there is a Python package of messages for a type."""
    return find_spec(type_name.partition('/')[0]) is not None
