# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recorded runs of all scenes, methods and kinds of commands, lived again in another process."""

import json
import os
import sys

from dynsim_ros.integrators import METHODS
from dynsim_ros.scene import load_scene, scene_names
from plain import environment
import pytest
from recorded import record, script, SCRIPTS
from tree import output_of

# `make rerun-grid` tries every combination, the suite each of the parts.
ALL = os.environ.get('DYNSIM_RERUN_GRID') == 'all'
TICKS = 120 if ALL else 40
# These take longer to compile than to run: with the grid only.
SLOW = ('stiff', 'radau', 'dop853')
COVER = [*((scene, 'rk4' if number % 2 else 'auto', SCRIPTS[number % len(SCRIPTS)])
           for number, scene in enumerate(scene_names())),
         *(('sphere_on_spring', method, SCRIPTS[number % len(SCRIPTS)])
           for number, method in enumerate(METHODS) if method not in SLOW)]
CASES = [(scene, method, name) for scene in scene_names() for method in METHODS
         for name in SCRIPTS] if ALL else COVER
AGAIN = """
import json, sys
from dynsim_ros.bag.reader import open_bag
from dynsim_ros.bag.recorded_run import RecordedRun
from dynsim_ros.bag.rerun import compare

for path in sys.argv[1:]:
    with open_bag(path) as bag:
        outcome = compare(RecordedRun(bag))
    print(json.dumps([outcome.states, outcome.hashes, outcome.commands,
                      str(outcome.difference or '')]))
"""


@pytest.fixture(scope='module')
def outcomes(tmp_path_factory):
    """Return {case: (what came of it, simulator at its end)}."""
    folder, ends = tmp_path_factory.mktemp('grid'), {}
    for number, (scene, method, name) in enumerate(CASES):
        ends[folder / f'{number}.mcap'] = record(
            folder / f'{number}.mcap', scene, TICKS, script(name, load_scene(scene), TICKS),
            integrator=method, step=0.004, tolerance=1e-5,
            anchor_interpolation=('hold', 'linear')[number % 2])
    lines = output_of([sys.executable, '-c', AGAIN, *ends], env=environment()).splitlines()
    return dict(zip(CASES, zip(map(json.loads, lines), ends.values()), strict=True))


@pytest.mark.timeout(3600 if ALL else 300)
@pytest.mark.parametrize('case', CASES, ids='-'.join)
def test_every_state_is_the_same_bits(outcomes, case):
    (states, hashes, commands, difference), end = outcomes[case]
    assert difference == ''
    scene, _, name = case
    assert commands == len(script(name, load_scene(scene), TICKS))
    assert states == end.tick + 1
    assert hashes >= 2
