# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is seen at a glance to be open is so when looked at closely."""

from dynsim_ros.integrators.closed_scene import Recogniser
from dynsim_ros.integrators.closed_scene.openness import Openness
from dynsim_ros.physics.drive import undisturbed_drive
from dynsim_ros.physics.model import build_model
from dynsim_ros.physics.state import initial_state
from dynsim_ros.scene import parse_scene
import pytest
from references import load

HANGING = """
anchors: {{hand: {{position: [0, 0, 2], velocity: {anchor}}}}}
gravity: 9.81
bodies: {{ball: {{shape: sphere, mass: 1, radius: 0.1, position: [0, 0, 1.2],
                velocity: {velocity}}}}}
springs: {{spring: {{from: hand, to: ball, stiffness: 100, natural_length: 0.5}}}}"""


def looked_at(scene):
    """Return whether a scene's start is plainly open, and whether it has a closed form."""
    model, drive = build_model(scene), undisturbed_drive(scene)
    state = initial_state(scene, model)
    recogniser = Recogniser(model, drive)
    glance, recogniser._openness = recogniser._openness, Openness(model._replace(springs=None),
                                                                  drive)
    return glance.is_plain(state), recogniser.closed_scene(state) is not None


@pytest.mark.parametrize('anchor, velocity, plainly_open, closed', [
    ([0, 0, 0], [0, 0, 1], False, True),
    ([0, 0, 0.5], [0, 0, 0], False, True),
    ([0, 0, 0], [0, 1e-9, 1], False, False),
    ([0, 0, 0], [0, 0.5, 1], True, False),
    ([0, 0.5, 0], [0, 0, 0], True, False)])
def test_along_and_across_the_spring(anchor, velocity, plainly_open, closed):
    scene = parse_scene(HANGING.format(anchor=anchor, velocity=velocity))
    assert looked_at(scene) == (plainly_open, closed)


@pytest.mark.parametrize('name', ['S1', 'S2', 'any_inertia', 'four_bodies', 'box_by_its_corner'])
def test_references(name):
    plainly_open, closed = looked_at(load(name)[0])
    assert not (plainly_open and closed)
    assert plainly_open or name not in ('S1', 'S2')
