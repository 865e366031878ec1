# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The arm that is kept beside the state: that it is the turned offset, and what it is for."""

from dataclasses import replace

from dynsim_ros.physics.arms import arm_of_state, with_arm
from dynsim_ros.physics.drive import Drive
from dynsim_ros.physics.model import build_model
from dynsim_ros.physics.motion import rates
from dynsim_ros.physics.reach import put_reach, reach_of_state
from dynsim_ros.physics.state import ARM, initial_state
from dynsim_ros.scene import load_scene
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

SCENE = load_scene('sphere_on_spring')
SPRING = SCENE.springs[0]
TURNED = replace(SPRING, from_=SPRING.to, to=SPRING.from_, from_offset=(0.01, -0.02, 0.05))


def start_of(scene):
    model = build_model(scene)
    return model, initial_state(scene, model)


@pytest.mark.parametrize('spring', [SPRING, TURNED], ids=['at Q', 'at P'])
def test_it_is_the_turned_offset(spring):
    scene = replace(SCENE, springs=(spring,))
    model, y = start_of(scene)
    ends = model.springs[0].q if spring is SPRING else model.springs[0].p
    w, *xyz = y[6:10]
    exact = Rotation.from_quat([*xyz, w]).apply(ends.offset[0])
    np.testing.assert_allclose(arm_of_state(model, y), exact, rtol=0, atol=1e-16)


@pytest.mark.parametrize('spring', [SPRING, TURNED], ids=['at Q', 'at P'])
def test_rates_with_the_arm_are_those_without(spring):
    scene = replace(SCENE, springs=(spring,))
    model, y = start_of(scene)
    drive = Drive(np.array([[0.1, 0.2, 2.0, 0.3, 0.0, -0.1]]), True, None, True)
    arm = arm_of_state(model, y)
    beside = np.concatenate([y, arm, np.zeros(5)])
    put_reach(reach_of_state(model, drive, 0.3, y, arm), 0.0, np.zeros(ARM + 3), beside)
    found, exact = np.zeros(len(y)), np.zeros(len(y))
    rates(with_arm(model), drive, 0.3, beside, found)
    rates(model, drive, 0.3, y, exact)
    np.testing.assert_allclose(found, exact, rtol=1e-14, atol=1e-14)
    # and the quaternion is not looked at, but for its own rate
    exact = found.copy()
    beside[6:10] = 1.0, 0.0, 0.0, 0.0
    rates(with_arm(model), drive, 0.3, beside, found)
    np.testing.assert_array_equal(np.delete(found, range(6, 10)), np.delete(exact, range(6, 10)))


@pytest.mark.parametrize('scene', [
    load_scene('particle_on_spring'), load_scene('two_anchors'), load_scene('spinning_box'),
    load_scene('double_pendulum_of_spheres'), replace(SCENE, springs=())],
    ids=['particle', 'two springs', 'box', 'two bodies', 'no spring'])
def test_elsewhere_there_is_none(scene):
    model, y = start_of(scene)
    assert arm_of_state(model, y) is None
    assert reach_of_state(model, None, 0.0, y, None) is None
    assert with_arm(model) is model


def test_it_lies_behind_the_state():
    assert len(start_of(SCENE)[1]) == ARM
