# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
from dynsim_ros.messages.qos import COMMAND, every_tick, LATCHED, offered, Qos, STATE
from dynsim_ros.messages.scene_channels import scene_channels
from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import Simulator
import pytest
from rosbags.rosbag2.metadata import dump_qos_v8, parse_qos
import yaml

KEYS = {'history', 'depth', 'reliability', 'durability', 'deadline', 'lifespan', 'liveliness',
        'liveliness_lease_duration', 'avoid_ros_namespace_conventions'}


@pytest.mark.parametrize('qos', [STATE, LATCHED, COMMAND, Qos('best_effort', depth=3)])
def test_profile_is_complete_and_read_by_rosbags(qos):
    text = qos.offered_qos_profiles()
    (profile,) = yaml.safe_load(text)
    assert set(profile) == KEYS
    (read,) = parse_qos(text)
    assert (read.reliability.name.lower(), read.durability.name.lower(), read.depth) == (
        qos.reliability, qos.durability, qos.depth)
    assert read.history.name == 'KEEP_LAST'
    assert (read.deadline.sec, read.deadline.nsec) == (9223372036, 854775807)
    assert offered(text) == qos
    assert offered(dump_qos_v8([read])) == qos


def test_profiles_that_differ_become_one_that_everybody_matches():
    text = STATE.offered_qos_profiles() + Qos('best_effort', depth=20).offered_qos_profiles()
    assert offered(text) == Qos(depth=20)


def test_unknown_history_becomes_the_default():
    text = LATCHED.offered_qos_profiles().replace('keep_last', 'unknown').replace('h: 1', 'h: 0')
    assert offered(text) == Qos(durability='transient_local')


def test_less_is_kept_of_each_where_there_are_many():
    assert [every_tick(topics).depth for topics in (1, 9, 20, 100, 2000, 9000)] == [
        1000, 1000, 1000, 200, 10, 10]
    simulator = Simulator(load_scene('sphere_on_spring'))
    channels = scene_channels(simulator.scene, simulator.layout)
    assert {channel.qos for channel in channels if channel.row} == {every_tick(9)}


@pytest.mark.parametrize('text', ['', '[]', ': [', '- 3', 'a: b', '- {depth: x}', '3'])
def test_unreadable_profiles_are_none(text):
    assert offered(text) is None


@pytest.mark.parametrize(('given', 'part'), [
    ({'reliability': 'best'}, "'best'"), ({'durability': 'x'}, "'x'"), ({'depth': 0}, 'depth 0')])
def test_impossible_qos_is_refused(given, part):
    with pytest.raises(ValueError, match=part):
        Qos(**given)
