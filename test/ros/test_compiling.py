# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A term that is switched off while the node runs: what that needs is compiled before."""

from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import SetValues, Simulator
import pytest
from ros_client import stamps
from scene_topics import DIAGNOSTICS, POSE, positions

TICK = 10_000_000
SWITCHED_OFF = {'air.linear_drag': 0.0, 'spring.damping': 0.0}


@pytest.fixture(scope='module')
def client(start, connect, tmp_path_factory):
    """Give a client of a node on a machine on which nothing has been compiled before."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('XDG_CACHE_HOME', str(tmp_path_factory.mktemp('cache')))
        node = start('-p', 'integrator:=rk4')
    client = connect(node)
    client.listen({'sphere/pose': POSE, '/diagnostics': DIAGNOSTICS})
    client.more('sphere/pose')
    return client


def missed_ticks(client):
    """Return how many ticks the next diagnostics tell of that were given up."""
    (array, *_) = client.more('/diagnostics')
    return {item.key: int(item.value) for item in array.status[0].values
            if item.key == 'missed ticks'}


def test_no_tick_is_missed_meanwhile(client):
    missed = missed_ticks(client)
    before = len(client.heard['sphere/pose'])
    assert client.set_group(SWITCHED_OFF).successful
    # it takes a second at the very least
    assert len(client.heard['sphere/pose']) > before + 50
    client.more('sphere/pose', 50)
    assert missed_ticks(client) == missed
    times = stamps(client.messages('sphere/pose'))
    assert times == list(range(times[0], times[0] + len(times) * TICK, TICK))


def test_all_ticks_are_those_of_a_run_offline(client):
    client.pause()
    client.drain()
    messages = client.messages('sphere/pose')
    simulator, switched = Simulator(load_scene('sphere_on_spring'), integrator='rk4'), 0
    for time_ns, position in zip(stamps(messages), positions(messages).tolist()):
        before = simulator.copy()
        simulator.advance(time_ns - simulator.time_ns)
        if simulator.snapshot().position('sphere').tolist() != position:
            # from the tick before on, once
            simulator, switched = before, switched + 1
            simulator.apply(SetValues(SWITCHED_OFF))
            simulator.advance(TICK)
        assert simulator.snapshot().position('sphere').tolist() == position
    assert switched == 1


def test_what_was_compiled_once_is_there(client):
    client.pause(False)
    client.more('sphere/pose')
    before = len(client.heard['sphere/pose'])
    for values in ({'air.linear_drag': 0.1, 'spring.damping': 0.5}, SWITCHED_OFF):
        assert client.set_group(values).successful
    assert len(client.heard['sphere/pose']) < before + 50
