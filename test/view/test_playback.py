# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which instant of a recorded run is shown."""

from dynsim_ros.view.playback import Playback
import pytest


@pytest.fixture
def playback():
    return Playback(1.0, 3.0)


def test_plays_at_its_speed(playback):
    playback.speed = 0.5
    playback.advance(1.0)
    assert playback.time == 1.5


def test_pauses_and_goes_on(playback):
    playback.toggle()
    playback.advance(1.0)
    assert playback.time == 1.0
    playback.toggle()
    playback.advance(0.25)
    assert playback.time == 1.25


def test_begins_again_at_the_end(playback):
    playback.seek(2.9)
    playback.advance(0.35)
    assert playback.time == pytest.approx(1.25)
    assert playback.is_playing


def test_stops_at_the_end_if_it_does_not_repeat(playback):
    playback.repeats = False
    playback.advance(5.0)
    assert (playback.time, playback.is_playing) == (3.0, False)
    playback.toggle()
    assert (playback.time, playback.is_playing) == (1.0, True)


def test_stays_within_a_section(playback):
    playback.choose(1.5, 2.0)
    assert playback.time == 1.5
    playback.seek(2.7)
    assert playback.time == 2.0
    playback.advance(0.1)
    assert playback.time == pytest.approx(1.6)
