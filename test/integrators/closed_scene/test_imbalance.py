# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bodies at rest that are seen at a glance not to stay there: those away from equilibrium."""

from dynsim_ros.integrators.closed_scene import Recogniser
from dynsim_ros.integrators.closed_scene.hold import holds_of
from dynsim_ros.integrators.closed_scene.imbalance import is_unbalanced
from dynsim_ros.physics.drive import undisturbed_drive
from dynsim_ros.physics.model import build_model
from dynsim_ros.physics.state import initial_state
from dynsim_ros.scene import Anchor, Particle, Scene, Sphere, Spring
import pytest

G, MASSES, STIFFNESSES, LENGTH, RADIUS = 9.81, (1.0, 0.25), (128.0, 64.0), 0.5, 0.125


def hanging(displaced, along):
    """
    Return a sphere on a spring with a particle on another one below it, both at rest.

    They hang in equilibrium, but for one of them that is displaced [m] along an axis.
    """
    (m, n), (k, j) = MASSES, STIFFNESSES
    top = -(LENGTH + (m + n) * G / k) - RADIUS
    places = [[0.0, 0.0, top], [0.0, 0.0, top - RADIUS - LENGTH - n * G / j]]
    for place, distance in zip(places, displaced):
        place[along] += distance
    bodies = [Sphere(name='upper', mass=m, radius=RADIUS, position=places[0]),
              Particle(name='lower', mass=n, position=places[1])]
    springs = [Spring(name='first', from_='hook', to='upper', to_offset=(0.0, 0.0, RADIUS),
                      stiffness=k, natural_length=LENGTH),
               Spring(name='second', from_='upper', from_offset=(0.0, 0.0, -RADIUS), to='lower',
                      stiffness=j, natural_length=LENGTH)]
    return Scene(bodies=bodies, springs=springs, gravity=G,
                 anchors=[Anchor(name='hook', position=(0.0, 0.0, 0.0))])


def looked_at(scene):
    """Return whether a scene's start is plainly out of balance, and whether it is one of rest."""
    model, drive = build_model(scene), undisturbed_drive(scene)
    state = initial_state(scene, model)
    closed = Recogniser(model, drive).closed_scene(state)
    return is_unbalanced(model, drive, state, holds_of(model, drive.anchors)), closed is not None


def test_equilibrium_is_left_to_the_closer_look():
    assert looked_at(hanging((0.0, 0.0), 2)) == (False, True)


@pytest.mark.parametrize('along', [0, 2])
@pytest.mark.parametrize('displaced', [(1e-6, 0.0), (0.0, 1e-6), (-0.1, -0.1)])
def test_what_hangs_elsewhere_moves(displaced, along):
    assert looked_at(hanging(displaced, along)) == (True, False)
