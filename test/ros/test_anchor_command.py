# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Anchors moved by topic."""

from geometry_msgs.msg import PointStamped
import numpy as np
import pytest
from scene_topics import DAMPING, forces, positions, SPHERE, xyz


@pytest.fixture(scope='module')
def node(start):
    return start('-p', 'record.enable:=true')


@pytest.fixture(scope='module')
def client(node, connect):
    client = connect(node)
    client.listen(SPHERE)
    client.more('sphere/pose')
    client.pause()
    return client


@pytest.fixture(autouse=True)
def at_rest_in_the_beginning(client):
    client.reset()
    client.clear()


def move(client, x, y, z, frame='world'):
    command = PointStamped()
    command.header.frame_id = frame
    command.point.x, command.point.y, command.point.z = x, y, z
    client.publish('hand/command', command)
    client.drain()


def hand(client, ticks):
    """Return the positions of the hand in the ticks that follow: (n, 3)."""
    return positions(client.steps(ticks, 'hand/pose'))


@pytest.mark.parametrize('frame', ['world', ''])
def test_hold(client, frame):
    assert hand(client, 2).tolist() == [[0.0, 0.0, 2.0]] * 2
    move(client, 0.1, 0.2, 2.3, frame)
    assert hand(client, 3).tolist() == [[0.1, 0.2, 2.3]] * 3


def test_the_last_of_several_counts(client):
    for x in (0.5, 0.4, 0.3):
        move(client, x, 0.0, 2.0)
    assert hand(client, 1).tolist() == [[0.3, 0.0, 2.0]]


def test_linear(client):
    assert client.configure({'anchor_interpolation': 'linear'})[0].successful
    move(client, 0.2, 0.0, 2.0)
    xs = hand(client, 15)[:, 0]
    # with no command before it the move takes 0.1 s
    np.testing.assert_allclose(xs, np.minimum(0.02 * np.arange(1, 16), 0.2), atol=1e-12)
    assert (xs[9:] == 0.2).all()


def test_a_stream_is_followed_evenly(client):
    assert client.configure({'anchor_interpolation': 'linear'})[0].successful
    seen = []
    for number in range(1, 16):
        move(client, 0.01 * number, 0.0, 2.0)
        seen.append(hand(client, 2)[-1, 0])
    # 0.5 m/s commanded: 0.01 m every second tick, one interval behind once under way
    np.testing.assert_allclose(np.diff(seen[6:]), 0.01, atol=1e-12)


def test_the_speed_of_the_anchor_is_felt_by_the_damper(client):
    assert client.configure({'anchor_interpolation': 'linear'})[0].successful
    client.steps(1, 'sphere/pose')
    still = forces(client.messages('sphere/wrench/damper'))[-1]
    pose, twist = client.last('sphere/pose'), client.last('sphere/twist')
    move(client, 0.0, 0.0, 3.0)
    client.steps(1, 'sphere/pose')
    moving = forces(client.messages('sphere/wrench/damper'))[-1]
    # 1 m within 0.1 s: 10 m/s upwards; in one tick nothing else changes by so much
    along = xyz(pose.pose.position) - (0.0, 0.0, 2.0)
    u = along / np.linalg.norm(along)
    jump = DAMPING * 10.0 * u[2] * u
    np.testing.assert_allclose(moving - still, jump, atol=0.25 * np.linalg.norm(jump))
    assert np.linalg.norm(jump) > 5.0 * abs(twist.twist.linear.z) * DAMPING


def test_the_body_follows(client):
    # by a method that does not go over to another one, for which it would be compiled meanwhile;
    # in few ticks, of which each is a message on every topic
    assert client.set_group({'spring.damping': 5.0, 'air.linear_drag': 4.0, 'rate': 10.0,
                             'air.rotational_drag': 0.05, 'integrator': 'rk4'}).successful
    move(client, 1.0, -0.5, 3.0)
    client.configure({'real_time_factor': 0.0})
    client.pause(False)
    client.wait(lambda: client.heard['sphere/pose']
                and client.last('sphere/pose').header.stamp.sec >= 20)
    client.pause()
    client.configure({'real_time_factor': 1.0})
    client.drain()
    x, y, z = xyz(client.last('sphere/pose').pose.position)
    # at rest it hangs below the hand: 0.5 m of spring, 9.81 N / 100 N/m more, and its radius
    assert (x, y, z) == pytest.approx((1.0, -0.5, 3.0 - 0.5 - 0.0981 - 0.1), abs=1e-3)
