# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which closed form a scene's motion is recognised as; nothing is compiled for that."""

from dynsim_ros.integrators.closed_scene import Recogniser
from dynsim_ros.physics.drive import Drive, initial_anchors
from dynsim_ros.physics.model import build_model
from dynsim_ros.physics.state import initial_state
from dynsim_ros.scene import parse_scene
import numpy as np

HEAD = 'name: scene\ndescription: For a test.\n'


def recognised(text, force=None, torque=None):
    """
    Return the names of what a ClosedScene is made of, {} for rest, None without a closed form.

    text: YAML, or a Scene; force, torque: commanded to the first body.
    """
    scene = parse_scene(HEAD + text) if isinstance(text, str) else text
    model = build_model(scene)
    start = initial_state(scene, model)
    pushes = None
    if force or torque:
        pushes = np.zeros_like(start)
        bodies = len(model.mass)
        pushes[3 * bodies:3 * bodies + 3] = force or 0.0
        if torque:
            pushes[6 * bodies + 4 * model.rigid:][:3] = torque
    drive = Drive(initial_anchors(scene), True, pushes, None)
    closed = Recogniser(model, drive).closed_scene(start)
    if closed is None:
        return None
    always = {'start', 'bodies', 'rigid', 'balance'}
    return {name for name, part in zip(closed._fields, closed)
            if part is not None and name not in always}
