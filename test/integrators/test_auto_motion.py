# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Closed forms where there are some, steps elsewhere: chosen anew whenever a motion begins."""

from dynsim_ros.integrators.auto_motion import AutoMotion
from dynsim_ros.physics.drive import Drive, initial_anchors
from dynsim_ros.physics.model import build_model
from dynsim_ros.physics.state import initial_state
import numpy as np
import pytest
from references import all_scenes


class Steps:
    """What stands for AutoSteps: it writes down what it is asked for."""

    def __init__(self):
        self.asked = []
        self.counts, self.removed, self.shortfall = np.arange(4), 0.25, 'a shortfall'

    def __getattr__(self, name):
        def answer(*arguments):
            self.asked.append((name, *arguments))
            return np.zeros(10)
        return answer


class Chosen:
    """An AutoMotion for a scene, with what it is given."""

    def __init__(self, name='particle_on_spring'):
        scene = all_scenes()[name]
        self.model = build_model(scene)
        self.state = initial_state(scene, self.model)
        self.drive = Drive(initial_anchors(scene), True, np.zeros_like(self.state), None)
        self.made = []
        self.motion = AutoMotion(self.model, self.drive, self.new_steps)

    def new_steps(self):
        self.made.append(Steps())
        return self.made[-1]

    def straight(self):
        """Return a state below the anchor, at rest: its motion has a closed form."""
        state = self.state.copy()
        state[:6] = 0.0, 0.0, 1.25, 0.0, 0.0, 0.0
        return state


def test_steps_are_made_when_first_needed_and_once():
    chosen = Chosen()
    motion = chosen.motion
    motion.begin(0, chosen.straight())
    assert motion.cut(10 ** 9)[2] != 1.25
    assert chosen.made == []
    assert motion.counts.tolist() == [0, 0, 0, 0] and motion.shortfall is None
    motion.begin(10 ** 9, chosen.state)
    motion.begin(2 * 10 ** 9, chosen.state)
    steps, = chosen.made
    assert [name for name, *_ in steps.asked] == ['begin', 'begin']
    assert motion.counts.tolist() == [0, 1, 2, 3]
    assert (motion.removed, motion.shortfall) == (0.25, 'a shortfall')


def test_what_steps_are_asked_for():
    chosen = Chosen()
    chosen.motion.begin(5, chosen.state)
    states = np.zeros((2, 10))
    chosen.motion.state_at(6, 9)
    chosen.motion.fill(7, 1, states, 9)
    chosen.motion.end_at(8)
    chosen.motion.cut(9)
    chosen.motion.prepare()
    chosen.motion.reset()
    assert chosen.made[0].asked[1:] == [
        ('state_at', 6, 9), ('fill', 7, 1, states, 9), ('end_at', 8), ('cut', 9), ('prepare',),
        ('reset',)]


def test_closed_again_after_steps():
    chosen = Chosen()
    motion = chosen.motion
    first = None
    for _ in range(2):
        motion.begin(0, chosen.straight())
        state = motion.state_at(123_456_789)
        assert first is None or np.array_equal(state, first)
        first = state
        motion.begin(123_456_789, chosen.state)
    assert len(chosen.made) == 1
    assert [name for name, *_ in chosen.made[0].asked] == ['begin', 'begin']


def test_a_push_is_read_where_the_motion_begins():
    chosen = Chosen()
    chosen.motion.begin(0, chosen.straight())
    before = chosen.motion.state_at(10 ** 8)
    chosen.drive.pushes[3:6] = 0.0, 0.0, 5.0
    np.testing.assert_array_equal(chosen.motion.cut(10 ** 8), before)
    chosen.motion.begin(0, chosen.straight())
    assert chosen.motion.state_at(10 ** 8)[2] > before[2]
    chosen.drive.pushes[3:6] = 1.0, 0.0, 0.0
    chosen.motion.begin(0, chosen.straight())
    assert len(chosen.made) == 1


@pytest.mark.parametrize('name, prepared', [
    ('particle_on_spring', True), ('spinning_box', True), ('free_flight', False)])
def test_steps_are_prepared_where_commands_may_need_them(name, prepared):
    chosen = Chosen(name)
    chosen.motion.begin(0, chosen.straight() if name == 'particle_on_spring' else chosen.state)
    chosen.motion.prepare()
    assert bool(chosen.made) is prepared


def test_the_budget_is_that_of_the_steps():
    chosen = Chosen()
    chosen.motion.budget = 77
    chosen.motion.begin(0, chosen.state)
    assert chosen.made[0].budget == 77
