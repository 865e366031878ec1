# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bodies pushed by topic; the box is free of all other forces."""

from geometry_msgs.msg import WrenchStamped
import numpy as np
import pytest
from scene_topics import BOX, DIAGNOSTICS, forces, PARTICLE, torques, velocities

TICK = 0.01


@pytest.fixture(scope='module')
def client(start, connect):
    client = connect(start('-p', 'scene:=spinning_box'))
    client.listen(BOX)
    client.more('box/pose')
    client.pause()
    return client


@pytest.fixture(autouse=True)
def initial_state(request):
    if 'client' in request.fixturenames:
        client = request.getfixturevalue('client')
        client.reset()
        client.clear()


def push(client, body, force=(0.0, 0.0, 0.0), torque=(0.0, 0.0, 0.0)):
    command = WrenchStamped()
    command.header.frame_id = 'world'
    for vector, numbers in ((command.wrench.force, force), (command.wrench.torque, torque)):
        vector.x, vector.y, vector.z = numbers
    client.publish(f'{body}/wrench_command', command)
    client.drain()


def net(client, ticks):
    """Return the force in x in the ticks that follow [N]."""
    return forces(client.steps(ticks, 'box/wrench/net'))[:, 0].tolist()


def test_momentum_is_force_times_time(client):
    client.configure({'wrench_timeout': 0.25})
    push(client, 'box', (2.0, 0.0, -4.0))
    client.steps(40, 'box/twist')
    np.testing.assert_allclose(velocities([client.last('box/twist')]),
                               [[2.0 * 0.25, 0.0, -4.0 * 0.25]], rtol=1e-9, atol=1e-12)


def test_ends_when_it_times_out(client):
    client.configure({'wrench_timeout': 0.03})
    push(client, 'box', (2.0, 0.0, 0.0))
    assert net(client, 5) == [2.0, 2.0, 0.0, 0.0, 0.0]


def test_default_time_out(client):
    push(client, 'box', (2.0, 0.0, 0.0))
    assert net(client, 52) == [2.0] * 49 + [0.0] * 3


def test_is_replaced_and_taken_back(client):
    push(client, 'box', (2.0, 0.0, 0.0))
    assert net(client, 2) == [2.0, 2.0]
    push(client, 'box', (-3.0, 0.0, 0.0))
    assert net(client, 2) == [-3.0, -3.0]
    push(client, 'box')
    assert net(client, 2) == [0.0, 0.0]


def test_lasts_until_replaced_without_time_out(client):
    client.configure({'wrench_timeout': 0.0})
    push(client, 'box', (1.0, 0.0, 0.0))
    assert net(client, 60) == [1.0] * 60


def test_torque_turns(client):
    push(client, 'box', torque=(0.0, 0.0, 0.001))
    messages = client.steps(3, 'box/wrench/net')
    assert torques(messages).tolist() == [[0.0, 0.0, 0.001]] * 3
    assert not forces(messages).any()


def test_reset_ends_it(client):
    push(client, 'box', (2.0, 0.0, 0.0))
    client.reset()
    client.drain()
    assert net(client, 2) == [0.0, 0.0]


def test_a_particle_takes_no_torque(start, connect):
    node = start('-p', 'scene:=particle_on_spring', '-r', '__ns:=/other', name='/other/dynsim')
    client = connect(node)
    client.listen({**PARTICLE, '/diagnostics': DIAGNOSTICS})
    client.more('particle/pose')
    client.pause()
    client.clear()
    push(client, 'particle', (3.0, 0.0, 0.0))
    client.steps(1, 'particle/wrench/net')
    total = sum(forces(client.messages(f'particle/wrench/{kind}'))
                for kind in ('spring', 'gravity'))
    np.testing.assert_allclose(
        forces(client.messages('particle/wrench/net')) - total, [[3.0, 0.0, 0.0]], atol=1e-12)
    push(client, 'particle', (5.0, 0.0, 0.0), torque=(0.0, 0.0, 0.1))
    client.wait(lambda: 'refused' in node.output)
    assert 'torque [0.0, 0.0, 0.1] N m cannot act on a particle' in node.output
    client.clear()
    client.steps(1, 'particle/wrench/net')
    total = sum(forces(client.messages(f'particle/wrench/{kind}'))
                for kind in ('spring', 'gravity'))
    np.testing.assert_allclose(
        forces(client.messages('particle/wrench/net')) - total, [[3.0, 0.0, 0.0]], atol=1e-12)
