# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Every scene of the package against a trajectory that was not computed by it.

How reference/references.json came about, and how it was verified, is in make_references.py.
"""

import json
from pathlib import Path

from dynsim_ros.scene import load_scene, scene_names
from dynsim_ros.simulation import Simulator
from newton_euler import rotation_distance, rotation_of
import numpy as np
import pytest

REFERENCES = json.loads(
    Path(__file__).with_name('reference').joinpath('references.json').read_text(encoding='utf-8'))


def test_there_is_one_for_every_scene():
    assert sorted(REFERENCES) == scene_names()


@pytest.mark.parametrize('name', REFERENCES)
def test_scene_follows_its_reference(name):
    reference = REFERENCES[name]
    simulator = Simulator(load_scene(name), step=2e-5)
    for time, motion in zip(reference['times'], reference['motions']):
        simulator.advance(round(time * 1e9) - simulator.time_ns)
        now = simulator.snapshot()
        for body, (r, v, *turning) in motion.items():
            np.testing.assert_allclose(now.position(body), r, atol=1e-10)
            np.testing.assert_allclose(now.velocity(body), v, atol=1e-10)
            assert len(turning) == (0 if now.orientation(body) is None else 2)
            if turning:
                assert rotation_distance(now.orientation(body), rotation_of(turning[0])) < 1e-10
                np.testing.assert_allclose(now.angular_velocity(body), turning[1], atol=1e-10)


@pytest.mark.parametrize('name', REFERENCES)
def test_the_default_step_is_fine_enough_to_look_at(name):
    """Within a tenth of a millimetre at the first time of the reference."""
    reference = REFERENCES[name]
    simulator = Simulator(load_scene(name))
    simulator.advance(round(reference['times'][0] * 1e9))
    for body, (r, *_) in reference['motions'][0].items():
        np.testing.assert_allclose(simulator.snapshot().position(body), r, atol=1e-4)
