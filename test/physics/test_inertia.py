# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Inertia of sphere, cube and box against the integral that defines it."""

from dynsim_ros.physics.inertia import body_inertia, box_inertia, cube_inertia, sphere_inertia
from dynsim_ros.physics.model import build_model
from dynsim_ros.scene import Box, Particle, RigidBody, Scene, Sphere
import numpy as np
import pytest
from scipy.integrate import tplquad


def test_sphere_is_two_fifths_m_r_squared():
    mass, radius = 3.0, 0.7
    density = mass / (4 / 3 * np.pi * radius ** 3)
    # in spherical coordinates, distance from the axis: s sin(theta)
    integral, _ = tplquad(lambda s, theta, phi: density * s ** 4 * np.sin(theta) ** 3,
                          0, 2 * np.pi, 0, np.pi, 0, radius)
    assert sphere_inertia(mass, radius) == pytest.approx(integral, rel=1e-12)
    assert sphere_inertia(mass, radius) == pytest.approx(2 / 5 * mass * radius ** 2, rel=1e-15)


def test_box():
    mass, size = 2.0, (0.3, 0.5, 1.1)
    density = mass / np.prod(size)
    half = np.array(size) / 2
    for axis, moment in enumerate(box_inertia(mass, size)):
        def distance_squared(z, y, x, axis=axis):
            return density * sum(np.delete((x, y, z), axis) ** 2)
        integral, _ = tplquad(distance_squared, -half[0], half[0], -half[1], half[1], -half[2],
                              half[2])
        assert moment == pytest.approx(integral, rel=1e-12)


def test_cube_is_the_box_with_equal_edges():
    assert box_inertia(2.0, (0.3, 0.3, 0.3)) == pytest.approx([cube_inertia(2.0, 0.3)] * 3)


@pytest.mark.parametrize('body, scalar', [
    (Sphere(name='b', mass=1, radius=2), True),
    (Box(name='b', mass=1, size=(2, 2, 2)), True),
    (Box(name='b', mass=1, size=(2, 2, 2.001)), False),
    (RigidBody(name='b', mass=1, inertia=2), True),
    (RigidBody(name='b', mass=1, inertia=(2, 2, 2)), True),
    (RigidBody(name='b', mass=1, inertia=((2, 0, 0), (0, 2, 0), (0, 0, 2))), True),
    (RigidBody(name='b', mass=1, inertia=(2, 2, 3)), False),
    (RigidBody(name='b', mass=1, inertia=((2, 0.1, 0), (0.1, 2, 0), (0, 0, 2))), False)])
def test_only_an_inertia_that_is_no_scalar_has_a_gyroscopic_term(body, scalar):
    model = build_model(Scene(bodies=(body,)))
    assert isinstance(body_inertia(body), float) is scalar
    assert (model.inertia is None) is scalar
    assert (model.round_inertia is not None) is scalar


def test_given_inertia_is_kept():
    moments = build_model(Scene(bodies=(RigidBody(name='b', mass=1, inertia=(1, 2, 2.5)),)))
    np.testing.assert_array_equal(moments.inertia[0], np.diag([1, 2, 2.5]))
    given = ((2, 0.1, 0), (0.1, 2, 0.3), (0, 0.3, 2))
    full = build_model(Scene(bodies=(RigidBody(name='b', mass=1, inertia=given),)))
    np.testing.assert_array_equal(full.inertia[0], given)
    np.testing.assert_allclose(full.inverse_inertia[0] @ given, np.eye(3), atol=1e-15)


def test_a_particle_has_none():
    with pytest.raises(TypeError, match='is a particle'):
        body_inertia(Particle(name='b', mass=1))
