# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bags of all kinds for the readers of others; where those are not set up, no test is here."""

from dynsim_ros.bag.recovery.recover import recover
from dynsim_ros.cli.simulate import main as simulate
from geometry_msgs.msg import PointStamped
from live_fixtures import connect, discovery, start
from other_readers import by_mcap_ros2
import pytest
from scene_topics import DIAGNOSTICS, POSE
from viewers import READY

__all__ = ['connect', 'discovery', 'start']
collect_ignore_glob = [] if READY.exists() else ['test_*.py']
STATE = {'/tf', '/dynsim/epoch', '/dynsim/state_hash', *(f'/dynsim/{topic}' for topic in (
    'sphere/pose', 'sphere/twist', 'hand/pose', 'energy', 'markers', 'sphere/wrench/spring',
    'sphere/wrench/damper', 'sphere/wrench/air', 'sphere/wrench/gravity', 'sphere/wrench/net'))}
LIVE = {'/diagnostics', '/dynsim/hand/command', '/dynsim/parameter_command'}


@pytest.fixture(scope='module', params=['zstd', 'lz4', 'none', 'recovered', 'live'])
def bag(request, tmp_path_factory):
    """Give the path of a bag that was compressed so, cut off and recovered, or recorded live."""
    if request.param == 'live':
        path = live(*map(request.getfixturevalue, ('start', 'connect')))
    else:
        compression = 'zstd' if request.param == 'recovered' else request.param
        path = tmp_path_factory.mktemp('bag') / 'run.mcap'
        assert simulate(['sphere_on_spring', '--duration', '2', '--compression', compression,
                         '--output', str(path), '--quiet']) == 0
    if request.param == 'recovered':
        content = path.read_bytes()
        path.write_bytes(content[:len(content) * 2 // 3])
        assert recover(path).messages > 1000
    return path


@pytest.fixture(scope='module')
def written(bag):
    """Give [topic, log time, message], as mcap-ros2-support has them of that bag."""
    messages = by_mcap_ros2(bag)
    topics = {topic for topic, _, _ in messages}
    assert topics == STATE | (LIVE if bag.parent.name == 'runs' else set())
    return messages


def live(start, connect):
    """Record a live run with a command and a changed parameter; return the bag's path."""
    node = start('-p', 'record.enable:=true')
    client = connect(node)
    client.listen({'sphere/pose': POSE, '/diagnostics': DIAGNOSTICS})
    # what is commanded before the first tick is a part of the scene that the bag begins with
    client.more('sphere/pose')
    point = PointStamped()
    point.point.x, point.point.z = 0.4, 2.5
    client.publish('hand/command', point)
    (result,) = client.configure({'gravity': 1.5})
    assert result.successful
    client.more('/diagnostics', 2)
    node.stop()
    (path,) = node.bags
    return path
