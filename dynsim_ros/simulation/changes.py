# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Changes of quantities and settings, checked as a whole."""

from dataclasses import replace

from .settings import SETTING_NAMES
from ..scene import did_you_mean, scene_quantities, SceneError, with_values


def changed(scene, settings, values, *, at_start=False):
    """
    Return (scene, settings) with some values changed, all of them or (SceneError) none.

    values: {name: value} of quantities of the scene and of settings; at_start: whether initial
    conditions may be among them.
    """
    quantities = scene_quantities(scene)
    for name in values:
        if name not in quantities and name not in SETTING_NAMES:
            known = [*SETTING_NAMES, *quantities]
            raise SceneError(f"'{name}' is no quantity of this scene and no setting; "
                             + did_you_mean(name, known))
        if name in quantities and quantities[name].initial and not at_start:
            raise SceneError(f'{name}: is an initial condition, fixed once the run has begun; '
                             'give it at the start')
    of_settings = {name: value for name, value in values.items() if name in SETTING_NAMES}
    of_scene = {name: value for name, value in values.items() if name not in SETTING_NAMES}
    return (with_values(scene, of_scene) if of_scene else scene,
            replace(settings, **of_settings) if of_settings else settings)
