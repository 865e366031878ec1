# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A loop that is written out does what the loop does, whatever the types of the members."""

from dynsim_ros.physics.each import each
import numba
import numpy as np
import pytest

twice = numba.njit(lambda x: x + x)
MEMBERS = (2, 1.5, np.array([1.0, -3.0]), (1, 2.0))


@pytest.mark.parametrize('compiled', [numba.njit, lambda function: function],
                         ids=['compiled', 'plain'])
def test_every_member_in_turn(compiled):
    function = compiled(each('members, k', 'twice(members[{i}])', len(MEMBERS), twice=twice))
    whole, half, array, pair = function(MEMBERS, 0)
    assert (whole, half, array.tolist(), pair) == (4, 3.0, [2.0, -6.0], (1, 2.0, 1, 2.0))


def test_no_members():
    assert numba.njit(each('members', 'members[{i}]', 0))(()) == ()


def test_the_number_of_each():
    assert each('k', '{i} * k', 3)(10) == (0, 10, 20)
