# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Rerun converts bags without a complaint, and shows the poses, frames and numbers in them."""

import numpy as np
import pytest
from viewers import by_rerun


@pytest.fixture(scope='module')
def found(bag, tmp_path_factory):
    return by_rerun(bag, tmp_path_factory.mktemp('rerun'))


def of(written, topic):
    """Return (log time, message) of a topic."""
    return [(time, message) for name, time, message in written if name == topic]


def single(fields, names):
    """Return numbers of a message as one vector in the precision of Rerun's own types."""
    return [[float(np.float32(fields[name])) for name in names]]


@pytest.mark.parametrize('topic', ['/dynsim/sphere/pose', '/dynsim/hand/pose'])
def test_poses(found, written, topic):
    assert found[topic] == [[time, {
        'CoordinateFrame:frame': ['world'],
        'InstancePoses3D:translations': single(message['pose']['position'], 'xyz'),
        'InstancePoses3D:quaternions': single(message['pose']['orientation'], 'xyzw'),
    }] for time, message in of(written, topic)]


def test_frames(found, written):
    assert found['/tf'] == [[time, {
        'Transform3D:parent_frame': ['world'],
        'Transform3D:child_frame': [part['child_frame_id']],
        'Transform3D:translation': single(part['transform']['translation'], 'xyz'),
        'Transform3D:quaternion': single(part['transform']['rotation'], 'xyzw'),
    }] for time, message in of(written, '/tf') for part in message['transforms']]


def test_energies(found, written):
    assert found['/dynsim/energy'] == [
        [time, {'Scalars:scalars': message['data']}]
        for time, message in of(written, '/dynsim/energy')]


def test_all_else_is_there_to_the_last_bit(found, written):
    topics = {topic for topic, _, _ in written}
    assert {path for path in found if not path.startswith('/__')} == topics
    for topic in topics - {'/tf', '/dynsim/sphere/pose', '/dynsim/hand/pose', '/dynsim/energy'}:
        shown = [(time, *components.values()) for time, components in found[topic]]
        assert shown == [(time, [message['data'] if topic == '/dynsim/state_hash' else message])
                         for time, message in of(written, topic)], topic
