# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is simulated: bodies, anchors, springs, air and gravity as data."""

from .air import Air
from .bodies import Box, Particle, Rigid, RigidBody, Sphere
from .connections import Anchor, Spring
from .errors import did_you_mean, SceneError, shown
from .library import load_scene, scene_names
from .quantity import Quantity
from .safe_yaml import load_yaml
from .scene import Scene
from .values import get_value, get_values, scene_quantities, with_values
from .yaml_file import parse_scene, read_scene, scene_to_yaml

__all__ = [
    'Air', 'Anchor', 'Box', 'Particle', 'Quantity', 'Rigid', 'RigidBody', 'Scene', 'SceneError',
    'Sphere', 'Spring', 'did_you_mean', 'get_value', 'get_values', 'load_scene', 'load_yaml',
    'parse_scene', 'read_scene', 'scene_names', 'scene_quantities', 'scene_to_yaml', 'shown',
    'with_values',
]
