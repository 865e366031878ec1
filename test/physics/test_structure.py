# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A small scene's structure in the type of its model, against newton_euler.py."""

from dataclasses import replace

from dynsim_ros.physics.drive import undisturbed_drive
from dynsim_ros.physics.known import Known, KnownIndex
from dynsim_ros.physics.model import build_model
from dynsim_ros.physics.motion import rates
from dynsim_ros.physics.offset import AxisOffset
from dynsim_ros.physics.structure import with_structure
from dynsim_ros.simulation.layout import Layout
from newton_euler import NewtonEuler
import numba
import numpy as np
import pytest
from random_states import difference, random_state
from structures import MANY, SEVERAL, SINGLE

TIME = 0.37


@numba.njit(error_model='numpy')
def compiled(model, drive, t, y, out):
    rates(model, drive, t, y, out)


def largest_difference(scene, call):
    """Return that of the accelerations at random states."""
    layout, random, found = Layout(scene), np.random.default_rng(5), []
    model, drive = with_structure(build_model(scene)), undisturbed_drive(scene)
    reference = NewtonEuler(scene)
    for _ in range(5):
        y, motion = random_state(layout, random)
        out = np.zeros(layout.size)
        call(model, drive, TIME, y, out)
        for body, (linear, angular) in reference.accelerations(
                TIME, reference.packed(motion)).items():
            found.append(difference(out[layout.velocity(body)], linear))
            if layout.angular_velocity(body) is not None:
                found.append(difference(out[layout.angular_velocity(body)], angular))
    return max(found)


@pytest.mark.parametrize('call', [rates, compiled], ids=['plain', 'compiled'])
@pytest.mark.parametrize('scene', [SEVERAL, SINGLE], ids=['several bodies', 'several springs'])
def test_the_accelerations_of_a_scene_whose_structure_is_known(scene, call):
    assert largest_difference(scene, call) < 1e-14


def test_each_spring_is_a_group_and_offsets_on_an_axis_are_told():
    model = with_structure(build_model(SEVERAL))
    assert isinstance(model.several[0], Known) and model.several == (4, 3)
    assert isinstance(model.general_body, KnownIndex)
    assert [len(group.stiffness) for group in model.springs] == [1] * 6
    offsets = [ends.offset for group in model.springs for ends in (group.p, group.q)
               if ends.body is not None]
    # that of the crate on `oblique` is zero: its centre is on every axis
    assert sorted(offset.axis for offset in offsets if isinstance(offset, AxisOffset)) == [
        0, 0, 1, 1, 2, 2, 2]
    assert [offset.tolist() for offset in offsets if isinstance(offset, np.ndarray)] == [
        [[0.1, 0.0, 0.1]]]


def test_one_body_on_one_spring_and_large_scenes_stay_as_they_are():
    one = build_model(replace(SINGLE, springs=SINGLE.springs[:1]))
    assert with_structure(one) is one
    many = build_model(MANY)
    assert with_structure(many) is many


def test_known_numbers_are_of_their_own_types_and_are_numbers_in_compiled_code():
    assert numba.typeof(Known(3)) == numba.typeof(Known(3)) != numba.typeof(Known(4))
    assert numba.typeof(KnownIndex((0, 2))) != numba.typeof(KnownIndex((0, 1)))

    @numba.njit
    def weighted(count, index):
        total = 0
        for i in range(2 * count - 3):
            total += 10 ** i * index[i]
        return total, len(index)

    assert weighted(Known(3), KnownIndex((7, 1, 5))) == (517, 3)
    assert weighted.py_func(Known(3), KnownIndex((7, 1, 5))) == (517, 3)
    assert weighted(Known(2), KnownIndex((4,))) == (4, 1)
    assert len(weighted.signatures) == 2
