# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Methods are chosen by name."""

from dynsim_ros.integrators import DEFAULT_METHOD, method_named, METHODS
from dynsim_ros.scene import SceneError
import pytest


def test_auto_is_the_default():
    assert DEFAULT_METHOD == 'auto'


@pytest.mark.parametrize('name', METHODS)
def test_by_name(name):
    assert method_named(name).name == name
    assert method_named(name).description


@pytest.mark.parametrize('name, hint', [
    ('rk5', "did you mean 'rk4'?"), ('explicit-euler', "did you mean 'explicit_euler'?"),
    ('zzz', 'known are: ' + ', '.join(sorted(METHODS))),
    (4, "did you mean 'rk4'?"), (None, 'known are: '), (['rk4'], "'rk4'")])
def test_an_unknown_name_is_one_line_with_the_nearest_known(name, hint):
    with pytest.raises(SceneError) as caught:
        method_named(name)
    assert str(caught.value).startswith('integrator: ')
    assert hint in str(caught.value)
