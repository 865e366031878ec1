# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A motion that is no longer finite: the node stops, says why, and nothing bad goes out."""

from diagnostic_msgs.msg import DiagnosticStatus
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
import numpy as np
import pytest
from ros_client import nanoseconds
from scene_topics import DIAGNOSTICS, forces, positions, SPHERE, torques, velocities

REASON = "the motion of 'sphere' is no longer finite"


@pytest.fixture(scope='module')
def node(start):
    return start('-p', 'record.enable:=true', '-p', 'integrator:=rk4')


@pytest.fixture(scope='module')
def client(node, connect):
    """Give a client of a node that was driven to divergence."""
    client = connect(node)
    client.listen({**SPHERE, '/diagnostics': DIAGNOSTICS})
    client.more('sphere/pose', 5)
    assert client.set_group({'spring.stiffness': 3e4, 'step': 0.01}).successful
    client.wait(lambda: REASON in node.output)
    client.drain()
    return client


def numbers(client):
    """Return all numbers that were heard, in one array."""
    wrenches = [client.messages(topic) for topic in SPHERE if '/wrench/' in topic]
    return np.concatenate([
        *map(forces, wrenches), *map(torques, wrenches), positions(client.messages('sphere/pose')),
        velocities(client.messages('sphere/twist')),
        np.array([message.data for message in client.messages('energy')]).reshape(-1, 3),
        np.array([[point.x, point.y, point.z] for array in client.messages('markers')
                  for marker in array.markers for point in marker.points])])


def test_all_that_went_out_is_finite(client):
    assert np.isfinite(numbers(client)).all()
    assert np.abs(numbers(client)).max() > 1e3, 'it did not diverge'


def test_the_log_says_it_once(node, client):
    client.more('/diagnostics', 2)
    assert node.output.count(REASON) == 1
    (line,) = [line for line in node.output.splitlines() if REASON in line]
    assert '[ERROR]' in line
    assert 's is kept; give a shorter step than 0.01 s' in line
    assert line.endswith('; then call ~/reset')


def test_diagnostics_say_it(client):
    (array, *_) = client.more('/diagnostics')
    assert array.status[0].level == DiagnosticStatus.ERROR
    assert array.status[0].message.startswith(REASON)


def test_it_stays_at_the_last_finite_state(client):
    last = client.last('sphere/pose')
    for answer in (client.step(), client.pause(False), client.step()):
        assert not answer.success and answer.message.startswith(REASON)
        assert answer.message.endswith('; then call ~/reset')
    client.drain()
    assert client.last('sphere/pose') == last
    (array, *_) = client.more('/diagnostics')
    assert nanoseconds(array.header.stamp) == nanoseconds(last.header.stamp)


def test_a_better_step_is_not_enough(client):
    assert client.configure({'step': 1e-5})[0].successful
    assert REASON in client.step().message


def test_every_service_says_it(node, client):
    answers = [client.pause(), client.record(False), client.reset()]
    assert all(answer.success and REASON in answer.message for answer in answers)


def test_the_bag_is_finished_and_finite(node, client):
    (path,) = node.bags
    with open(path, 'rb') as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        assert reader.get_summary().statistics.message_count > 50
        poses = [message for _, _, _, message in reader.iter_decoded_messages(
            topics=['/dynsim/sphere/pose'])]
    assert np.isfinite(positions(poses)).all()


def test_after_a_reset_it_runs_again(client):
    for heard in client.heard.values():
        heard.clear()
    client.more('sphere/pose', 10)
    (array, *_) = client.more('/diagnostics')
    assert (array.status[0].level, array.status[0].message) == (DiagnosticStatus.OK, 'running')
    assert client.get('spring.stiffness', 'step') == [100.0, 0.001]
    assert np.abs(positions(client.messages('sphere/pose'))).max() < 3.0
    assert client.pause().message.startswith('paused at tick ')
    assert client.step().success
