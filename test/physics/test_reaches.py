# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The vectors of several springs that are kept beside the state, beside exact fractions."""

from dataclasses import replace
from fractions import Fraction

from dynsim_ros.physics.drive import undisturbed_drive
from dynsim_ros.physics.forces import arm_of
from dynsim_ros.physics.model import build_model
from dynsim_ros.physics.motion import rates
from dynsim_ros.physics.reaches import put_reaches, reaches_of_state, with_reaches
from dynsim_ros.physics.state import EXCESS, REACH_SIZE
from dynsim_ros.physics.structure import with_structure
from dynsim_ros.scene import load_scene
from dynsim_ros.simulation.layout import Layout
import numba
import numpy as np
import pytest
from random_states import random_state
from structures import MANY, SEVERAL, SINGLE

TIME, WAY = 7.3, 0.02
# With each kind of end once, so that it is soon compiled.
SCENE = replace(SEVERAL, springs=[spring for spring in SEVERAL.springs
                                  if spring.name in ('above', 'oblique', 'aside')])
# Far from the origin, in all three directions.
AWAY = 300.0


@numba.njit(error_model='numpy', _nrt=False)
def compiled(model, drive, t, way, y, here, state, out):
    put_reaches(model, drive, reaches_of_state(model, drive, t, y), way, here, state)
    rates(with_reaches(model), drive, t + way, state, out)


def plain(model, drive, t, way, y, here, state, out):
    compiled.py_func(model, drive, t, way, y, here, state, out)


def moved():
    """Return the model, drive, a state far away, how it changes, and the state that it becomes."""
    model, drive = with_structure(build_model(SCENE), True), undisturbed_drive(SCENE)
    layout = Layout(SCENE)
    random = np.random.default_rng(8)
    y, _ = random_state(layout, random)
    for body in layout.bodies:
        y[layout.position(body)] += AWAY
    anchors = drive.anchors.copy()
    anchors[:, :3] += AWAY - TIME * anchors[:, 3:]
    here = 1e-3 * random.normal(size=layout.size)
    room = np.zeros(REACH_SIZE * len(model.springs))
    return (model, drive._replace(anchors=anchors), y, here, np.concatenate([y + here, room]))


def exact_end(model, drive, ends, y, here, state):
    """Return where an end of a spring is: (3,) Fractions; its arm is what it is in the state."""
    if ends.anchor is not None:
        position, velocity = np.split(drive.anchors[ends.anchor[0]], 2)
        return [Fraction(x) + (Fraction(TIME) + Fraction(WAY)) * Fraction(v)
                for x, v in zip(position, velocity)]
    i, = ends.particle or ends.body
    arm = (0, 0, 0) if ends.body is None else arm_of(len(model.mass), i, ends.offset, 0, state)
    return [Fraction(float(x)) + Fraction(float(d)) + Fraction(float(a))
            for x, d, a in zip(y[3 * i:], here[3 * i:], arm)]


@pytest.mark.parametrize('call', [plain, compiled])
def test_reaches_and_excesses_have_no_rounding_of_positions(call):
    model, drive, y, here, state = moved()
    call(model, drive, TIME, WAY, y, here, state, np.zeros(len(state)))
    for group in model.springs:
        p, q = (exact_end(model, drive, ends, y, here, state) for ends in (group.p, group.q))
        exact = [b - a for a, b in zip(p, q)]
        found = state[group.reach_at:][:REACH_SIZE]
        np.testing.assert_allclose(found[:3], [float(r) for r in exact], rtol=3e-16, atol=1e-18)
        excess = sum(r * r for r in exact) - Fraction(float(group.natural_length[0])) ** 2
        assert found[EXCESS] == pytest.approx(float(excess), rel=3e-16, abs=2e-18)


@pytest.mark.parametrize('call', [plain, compiled])
def test_rates_with_reaches_are_those_without(call):
    model, drive, y, here, state = moved()
    found, exact = np.zeros(len(state)), np.zeros(len(state))
    call(model, drive, TIME, WAY, y, here, state, found)
    rates(model, drive, TIME + WAY, state, exact)
    # positions are known to 6e-14, of which springs of 100 N / m make forces
    np.testing.assert_allclose(found, exact, rtol=0, atol=1e-10)
    assert not np.array_equal(found, exact)


@pytest.mark.parametrize('scene', [
    load_scene('sphere_on_spring'), SINGLE, MANY, replace(SEVERAL, springs=())],
    ids=['sphere', 'several springs', 'many bodies', 'no spring'])
def test_elsewhere_there_are_none(scene):
    model = with_structure(build_model(scene), True)
    assert reaches_of_state(model, None, 0.0, None) is None
    assert with_reaches(model) is model
