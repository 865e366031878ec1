# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The sheet's section 2.1: position and velocity of the attachment point Q."""

from dynsim_ros.physics.kinematics import (attachment_arm, attachment_position,
                                           attachment_velocity)
from dynsim_ros.physics.rotation import rotation_matrix
from dynsim_ros.scene import Box, Particle, RigidBody, Sphere
from newton_euler import rotation_of
import numpy as np
from plain import compiled_and_plain, vectors
import pytest
from scipy.spatial.transform import Rotation


def quaternions(count):
    for rotation in Rotation.random(count, np.random.default_rng(5)):
        yield tuple(np.roll(rotation.as_quat(), 1).tolist())


@compiled_and_plain(attachment_arm)
def test_arm_is_the_offset_turned_from_body_to_world(formula):
    for q, offset in zip(quaternions(20), vectors(20)):
        np.testing.assert_allclose(formula(q, offset), rotation_of(q).apply(offset), atol=2e-15)


@compiled_and_plain(attachment_arm)
def test_on_the_edge_of_a_sphere_the_arm_is_r_times_b_z(formula):
    sphere = Sphere(name='s', mass=1, radius=0.25)
    for q in quaternions(10):
        b_z = np.array(rotation_matrix(q))[:, 2]
        np.testing.assert_allclose(formula(q, sphere.default_offset), 0.25 * b_z, atol=1e-16)


@compiled_and_plain(attachment_position)
def test_position_of_q_is_that_of_the_centre_plus_the_arm(formula):
    for centre, arm in zip(vectors(5), vectors(6)):
        np.testing.assert_array_equal(formula(centre, arm), np.add(centre, arm))


@compiled_and_plain(attachment_velocity)
def test_velocity_of_q_is_v_plus_omega_cross_arm(formula):
    for v, omega, arm in zip(vectors(10), vectors(11), vectors(12)):
        np.testing.assert_allclose(formula(v, omega, arm), v + np.cross(omega, arm), rtol=1e-13)


def test_velocity_of_q_is_the_derivative_of_its_position():
    (centre, v, omega, offset), h = vectors(4), 1e-5
    q = next(quaternions(1))

    def position(t):
        turned = Rotation.from_rotvec(np.array(omega) * t) * rotation_of(q)
        return np.array(attachment_position(tuple(np.array(centre) + t * np.array(v)),
                                            tuple(turned.apply(offset))))

    np.testing.assert_allclose(attachment_velocity(v, omega, attachment_arm(q, offset)),
                               (position(h) - position(-h)) / (2 * h), atol=1e-9)


@pytest.mark.parametrize('body, offset', [
    (Sphere(name='b', mass=1, radius=0.3), (0.0, 0.0, 0.3)),
    (Box(name='b', mass=1, size=(1, 2, 3)), (0.0, 0.0, 1.5)),
    (RigidBody(name='b', mass=1, inertia=1), (0.0, 0.0, 0.0)),
    (Particle(name='b', mass=1), None)])
def test_default_attachment_point(body, offset):
    assert body.default_offset == offset
