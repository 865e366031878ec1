# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Names of bodies, anchors and springs; they become parts of topic and parameter names."""

import re

from .errors import SceneError, shown

_NAME = re.compile(r'[A-Za-z](_?[A-Za-z0-9])*')

# Names of parameter groups that stand beside the scene's own.
RESERVED = frozenset({
    'air', 'anchor_interpolation', 'down', 'duration', 'gravity', 'integrator', 'publish_clock',
    'qos_overrides', 'rate', 'real_time_factor', 'record', 'scene', 'step', 'use_sim_time',
    'wrench_timeout'})


def check_name(name):
    """Raise SceneError unless the name can be part of a ROS topic and parameter name."""
    if not isinstance(name, str) or not _NAME.fullmatch(name):
        raise SceneError(f'name {shown(name)}: a name begins with a letter and has letters, '
                         'digits and single underscores within')
    if name in RESERVED:
        raise SceneError(f"name '{name}' is taken by a parameter of the node; choose another")
