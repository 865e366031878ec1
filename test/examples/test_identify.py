# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The example that identifies a spring from a bag."""

import re
import sys

from dynsim_ros.cli.simulate import main as simulate
import pytest
from tree import output_of, ROOT

STIFFNESS, DAMPING = 137.0, 0.8


@pytest.fixture(scope='module')
def bag(tmp_path_factory):
    path = tmp_path_factory.mktemp('bag') / 'run.mcap'
    assert simulate(['sphere_on_spring', '-q', '-d', '8', '-o', str(path), '--set',
                     f'spring.stiffness={STIFFNESS}', f'spring.damping={DAMPING}']) == 0
    return path


@pytest.mark.parametrize('noise', [0.0, 0.001])
def test_it_finds_what_the_bag_was_recorded_with(bag, noise):
    text = output_of([sys.executable, ROOT / 'examples' / 'identify.py', bag, '--noise', noise])
    found = [(float(value), float(spread))
             for value, spread in re.findall(r': ([\d.e-]+) \+- ([\d.e-]+) N', text)]
    for (value, spread), true in zip(found, (STIFFNESS, DAMPING), strict=True):
        assert abs(value - true) < max(5.0 * spread, 1e-4 * true)
        assert spread < 1e-3 * true
