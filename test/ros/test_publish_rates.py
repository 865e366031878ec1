# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Stepping at one rate and publishing at others, each an integer divisor of it."""

from live_node import start_refused, with_parameters
from mcap.reader import make_reader
import pytest
from ros_client import stamps
from scene_topics import NUMBERS, POSE, WRENCH
from std_srvs.srv import SetBool

TICK = 1_000_000
RATES = {'rate': 1000.0, 'publish_rate.state': 100.0, 'publish_rate.wrench': 250.0,
         'publish_rate.energy': 500.0}
TOPICS = {'sphere/pose': POSE, 'sphere/wrench/net': WRENCH, 'energy': NUMBERS}


@pytest.fixture(scope='module')
def node(start):
    return start(*with_parameters(RATES), '-p', 'integrator:=rk4')


@pytest.fixture(scope='module')
def client(node, connect):
    client = connect(node)
    client.listen(TOPICS)
    client.more('sphere/pose')
    return client


def hold(client):
    """Pause; poses do not tell of every tick here, so do not wait for one."""
    assert client.call('pause', SetBool, data=True).success


def heard_in_steps(client, count):
    """Return {topic: number of messages} that so many steps publish."""
    hold(client)
    client.reset()
    client.clear()
    for _ in range(count):
        assert client.step().success
    client.drain()
    return {topic: len(heard) for topic, heard in client.heard.items()}


def test_each_group_at_its_rate(client):
    client.more('sphere/pose', 10)
    hold(client)
    client.drain()
    for topic, every in (('sphere/pose', 10), ('sphere/wrench/net', 4)):
        times = stamps(client.messages(topic))
        assert times == list(range(times[0], times[0] + len(times) * every * TICK, every * TICK))
        assert times[0] % (every * TICK) == 0


def test_steps_publish_what_is_due(client):
    assert heard_in_steps(client, 20) == {
        'sphere/pose': 2, 'sphere/wrench/net': 5, 'energy': 10}


def test_no_wrenches(client):
    assert client.configure({'publish_wrenches': False})[0].successful
    hold(client)
    client.clear()
    assert heard_in_steps(client, 20)['sphere/wrench/net'] == 0
    assert client.configure({'publish_wrenches': True})[0].successful
    assert heard_in_steps(client, 4)['sphere/wrench/net'] == 1


def test_what_is_no_divisor_is_refused(client):
    (result,) = client.configure({'publish_rate.state': 300.0})
    assert not result.successful
    assert result.reason == ('publish_rate.state: 300 Hz is no integer divisor of rate, 1000 Hz; '
                             'the nearest ones are 333.3333 and 250 Hz')
    (result,) = client.configure({'rate': 50.0})
    assert not result.successful and 'is more than the rate of the ticks, 50 Hz' in result.reason
    assert client.get('publish_rate.state', 'rate') == [100.0, 1000.0]


def test_together_with_the_rate_and_back_by_a_reset(client):
    assert client.set_group({'rate': 90.0, 'publish_rate.state': 45.0, 'publish_rate.wrench': 0.0,
                             'publish_rate.energy': 30}).successful
    client.reset()
    assert client.get(*RATES) == list(RATES.values())
    assert heard_in_steps(client, 20) == {
        'sphere/pose': 2, 'sphere/wrench/net': 5, 'energy': 10}


def test_at_the_start(tmp_path):
    line = start_refused(tmp_path, '-p', 'publish_rate.energy:=30.0')
    assert line.endswith('the nearest ones are 33.33333 and 25 Hz')


def test_recorded_is_what_is_published(start):
    node = start(*with_parameters({**RATES, 'record.enable': 'true', 'duration': 0.1,
                                   'publish_wrenches': 'false'}), '-r', '__ns:=/recorded')
    node.wait()
    with open(node.bags[0], 'rb') as stream:
        summary = make_reader(stream).get_summary()
    counts = {summary.channels[number].topic.removeprefix('/recorded/dynsim/'): count
              for number, count in summary.statistics.channel_message_counts.items()}
    assert (counts['sphere/pose'], counts['energy']) == (11, 51)
    assert not any('wrench/' in topic for topic in counts if counts[topic])
