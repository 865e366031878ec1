# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The example of a parameter sweep, without ROS."""

import sys

from dynsim_ros.scene import load_scene, with_values
from dynsim_ros.simulation import Simulator
import numpy as np
import pytest
from tree import output_of, ROOT


@pytest.mark.timeout(300)  # compiles first
def test_it_finds_how_far_the_sphere_swings():
    text = output_of([sys.executable, ROOT / 'examples' / 'sweep.py', '--processes', 1])
    heading, dampings, *rows, best = text.splitlines()
    found = np.array([[float(cell) for cell in row.split()[2:]] for row in rows])
    assert found.shape == (4, 6) and dampings.split()[:-2] == ['0.1', '0.5', '2', '5', '10', '20']
    assert best == 'least: 50 N/m, 2 N s/m'
    # one of them once more, by what counts energies too
    scene = with_values(load_scene('sphere_on_spring'), {'spring.damping': 2.0})
    height = Simulator(scene).run(30.0).position('sphere')[2500:, 2]
    assert found[2, 2] == pytest.approx(1e3 * np.ptp(height), rel=0.01)
