# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The Python class of a message type, by its name."""

from importlib import import_module


def message_class(type_name):
    """Return the class of 'package/msg/Name'; raise ImportError or AttributeError."""
    package, folder, name = type_name.split('/')
    return getattr(import_module(f'{package}.{folder}'), name)
