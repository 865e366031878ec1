# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A loop that is written out does what the loop does, whatever the types of the members."""

from dynsim_ros.physics.each import each
import numba
import numpy as np
import pytest

twice = numba.njit(lambda x: x + x)


def doubled(members, k):
    return tuple(twice.py_func(member) for member in members)


MEMBERS = (2, 1.5, np.array([1.0, -3.0]), (1, 2.0))


@pytest.mark.parametrize('compiled', [numba.njit, lambda function: function],
                         ids=['compiled', 'plain'])
def test_every_member_in_turn(compiled):
    function = compiled(each(doubled, 'twice(members[{i}])', len(MEMBERS)))
    whole, half, array, pair = function(MEMBERS, 0)
    assert (whole, half, array.tolist(), pair) == (4, 3.0, [2.0, -6.0], (1, 2.0, 1, 2.0))


def test_no_members():
    assert numba.njit(each(doubled, 'twice(members[{i}])', 0))((), 0) == ()


def test_the_number_of_each():
    assert each(doubled, '{i} * k', 3)((), 10) == (0, 10, 20)
