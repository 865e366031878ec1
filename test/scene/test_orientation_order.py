# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Quaternions: the order of their numbers, axis and angle, norm."""

from dynsim_ros.scene import parse_scene
from dynsim_ros.scene.orientation import from_axis_angle, from_ros, to_ros, unit
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

SPHERE = 'bodies: {{s: {{shape: sphere, mass: 1, radius: 1, orientation: {}}}}}'


def test_order_of_the_numbers():
    assert to_ros((1, 2, 3, 4)) == (2, 3, 4, 1)
    assert from_ros((2, 3, 4, 1)) == (1, 2, 3, 4)


def test_axis_and_angle():
    for axis in np.random.default_rng(1).normal(size=(10, 3)):
        for angle in (0.0, 1e-9, 0.3, 3.0, -2.0):
            turn = Rotation.from_rotvec(axis / np.linalg.norm(axis) * angle)
            np.testing.assert_allclose(to_ros(from_axis_angle(axis, angle)), turn.as_quat(),
                                       atol=1e-15)


@pytest.mark.parametrize('written', ['{axis: [2, 0, 0], angle: 0.6}', '[0.29552, 0, 0, 0.95534]',
                                     '{w: 0.95534, x: 0.29552, y: 0, z: 0}'])
def test_the_three_ways_to_write_one(written):
    q = parse_scene(SPHERE.format(written)).bodies[0].orientation
    np.testing.assert_allclose(q, (np.cos(0.3), np.sin(0.3), 0, 0), atol=5e-6)


def test_making_the_norm_1_twice_changes_no_bit():
    for q in np.random.default_rng(2).normal(size=(5000, 4)):
        once = unit(tuple((q / np.linalg.norm(q)).tolist()))
        assert unit(once) == once
        assert np.linalg.norm(once) == pytest.approx(1, abs=5e-16)
