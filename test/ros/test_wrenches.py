# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The forces on topics, against formulas that a subscriber works out from pose and twist."""

import numpy as np
import pytest
from scene_topics import (
    angular_velocities,
    DAMPING,
    forces,
    GRAVITY,
    INERTIA,
    LINEAR_DRAG,
    MASS,
    NATURAL_LENGTH,
    positions,
    RADIUS,
    ROTATIONAL_DRAG,
    SPHERE,
    STIFFNESS,
    torques,
    velocities,
)
from scipy.spatial.transform import Rotation

TICK = 0.01


@pytest.fixture(scope='module')
def heard(start, connect):
    """Give {topic: messages} of 60 ticks one behind the other."""
    client = connect(start())
    client.listen(SPHERE)
    client.more('sphere/pose')
    client.pause()
    client.drain()
    client.clear()
    client.steps(60, 'sphere/pose')
    return {topic: client.messages(topic) for topic in SPHERE}


@pytest.fixture(scope='module')
def spring(heard):
    """Give lever (sphere's centre to Q), direction hand to Q, length [m], its rate [m/s]."""
    poses, twists = heard['sphere/pose'], heard['sphere/twist']
    q = [pose.pose.orientation for pose in poses]
    lever = Rotation.from_quat([(a.x, a.y, a.z, a.w) for a in q]).apply((0.0, 0.0, RADIUS))
    along = positions(poses) + lever - positions(heard['hand/pose'])
    length = np.linalg.norm(along, axis=1)
    u = along / length[:, None]
    velocity = velocities(twists) + np.cross(angular_velocities(twists), lever)
    return lever, u, length, (velocity * u).sum(axis=1)


def test_all_have_come(heard):
    assert {len(heard[topic]) for topic in SPHERE if topic != 'markers'} == {60}
    assert len(heard['markers']) == 15


def test_spring(heard, spring):
    _, u, length, _ = spring
    expected = -STIFFNESS * (length - NATURAL_LENGTH)[:, None] * u
    assert np.abs(expected).max() > 5.0
    np.testing.assert_allclose(forces(heard['sphere/wrench/spring']), expected, atol=1e-6)


def test_damper(heard, spring):
    _, u, _, rate = spring
    expected = -DAMPING * rate[:, None] * u
    assert np.abs(expected).max() > 0.1
    np.testing.assert_allclose(forces(heard['sphere/wrench/damper']), expected, atol=1e-7)


@pytest.mark.parametrize('kind', ['spring', 'damper'])
def test_moment_of_what_pulls_at_the_edge(heard, spring, kind):
    messages = heard[f'sphere/wrench/{kind}']
    expected = np.cross(spring[0], forces(messages))
    assert np.abs(expected).max() > 1e-3
    np.testing.assert_allclose(torques(messages), expected, atol=1e-12)


def test_air(heard):
    messages, twists = heard['sphere/wrench/air'], heard['sphere/twist']
    np.testing.assert_allclose(forces(messages), -LINEAR_DRAG * velocities(twists), atol=1e-14)
    np.testing.assert_allclose(
        torques(messages), -ROTATIONAL_DRAG * angular_velocities(twists), atol=1e-14)


def test_gravity(heard):
    messages = heard['sphere/wrench/gravity']
    assert (forces(messages) == (0.0, 0.0, -MASS * GRAVITY)).all()
    assert not torques(messages).any()


@pytest.mark.parametrize('part', [forces, torques])
def test_net_is_the_sum(heard, part):
    total = sum(part(heard[f'sphere/wrench/{kind}'])
                for kind in ('spring', 'damper', 'air', 'gravity'))
    np.testing.assert_allclose(part(heard['sphere/wrench/net']), total, atol=1e-12)


def over_two_ticks(values):
    """Return the integral of values over each two ticks, by Simpson's rule."""
    return TICK / 3.0 * (values[:-2] + 4.0 * values[1:-1] + values[2:])


@pytest.mark.parametrize(('cause', 'effect'), [
    (lambda heard: forces(heard['sphere/wrench/net']) / MASS,
     lambda heard: velocities(heard['sphere/twist'])),
    (lambda heard: torques(heard['sphere/wrench/net']) / INERTIA,
     lambda heard: angular_velocities(heard['sphere/twist'])),
    (lambda heard: velocities(heard['sphere/twist']),
     lambda heard: positions(heard['sphere/pose'])),
], ids=['newton', 'euler', 'position'])
def test_motion_follows_from_it(heard, cause, effect):
    change = effect(heard)[2:] - effect(heard)[:-2]
    assert np.abs(change).max() > 1e-3
    np.testing.assert_allclose(over_two_ticks(cause(heard)), change,
                               atol=2e-4 * np.abs(change).max())


def test_energy(heard, spring):
    v, omega = velocities(heard['sphere/twist']), angular_velocities(heard['sphere/twist'])
    kinetic = 0.5 * MASS * (v ** 2).sum(axis=1) + 0.5 * INERTIA * (omega ** 2).sum(axis=1)
    height = positions(heard['sphere/pose'])[:, 2]
    expected = np.array([kinetic, MASS * GRAVITY * height,
                         0.5 * STIFFNESS * (spring[2] - NATURAL_LENGTH) ** 2]).T
    found = np.array([message.data for message in heard['energy']])
    np.testing.assert_allclose(found[:, :3], expected, rtol=1e-6, atol=1e-9)
    # what is lost went to the damper and the air: no energy comes from nowhere
    assert np.abs(found[:, 8]).max() < 1e-6
    assert found[-1, 3] < found[0, 3]
