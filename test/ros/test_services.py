# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Pause, step and reset."""

from geometry_msgs.msg import PointStamped
import pytest
from ros_client import LATCHED, stamps
from scene_topics import DIAGNOSTICS, EPOCH, SPHERE
from std_srvs.srv import SetBool, Trigger

TICK = 10_000_000


@pytest.fixture(scope='module')
def client(start, connect):
    client = connect(start())
    client.listen({**SPHERE, '/diagnostics': DIAGNOSTICS})
    client.listen({'epoch': EPOCH}, LATCHED)
    client.more('sphere/pose')
    return client


@pytest.fixture(autouse=True)
def running(client):
    assert client.pause(False).success


def told(client):
    """Return (message, {key: value}) of the run in the next diagnostics."""
    (array, *_) = client.more('/diagnostics')
    return array.status[0].message, {item.key: item.value for item in array.status[0].values}


def test_pause_stops_and_goes_on_where_it_stopped(client):
    client.more('sphere/pose', 5)
    response = client.pause()
    assert response.success and response.message.startswith('paused at tick ')
    client.drain()
    client.clear()
    assert told(client)[0] == 'paused'
    assert not client.heard['sphere/pose']
    tick = int(response.message.split()[3].rstrip(','))
    assert client.pause(False).success
    assert stamps(client.more('sphere/pose', 3))[:3] == [
        (tick + 1) * TICK, (tick + 2) * TICK, (tick + 3) * TICK]
    assert told(client)[0] == 'running'


def test_step_while_running_is_refused(client):
    response = client.step()
    assert (response.success, response.message) == (
        False, 'not paused: call ~/pause with data true first')


def test_pause_twice_is_no_error(client):
    assert client.pause().success
    assert client.pause().success
    assert client.pause(False).success
    assert client.pause(False).success


def test_a_step_is_one_tick(client):
    client.pause()
    client.drain()
    before = stamps([client.last('sphere/pose')])[0]
    client.clear()
    for number in range(1, 6):
        assert client.step().message == (
            f'tick {before // TICK + number}, {before * 1e-9 + number * 0.01:.9g} s')
    client.drain()
    for topic in ('sphere/pose', 'sphere/twist', 'sphere/wrench/net', 'hand/pose'):
        assert stamps(client.messages(topic)) == [before + i * TICK for i in range(1, 6)]


def test_steps_without_waiting_for_the_answers(client):
    client.pause()
    client.drain()
    before = stamps([client.last('sphere/pose')])[0]
    client.clear()
    # no more than ten: a service keeps that many waiting
    futures = [client.call_async('step', Trigger) for _ in range(10)]
    client.wait(lambda: all(future.done() for future in futures))
    client.drain()
    assert stamps(client.messages('sphere/pose')) == [
        before + i * TICK for i in range(1, 11)]


def test_pause_and_step_at_once_are_in_order(client):
    # whatever tick it is: after the pause nothing but the step moves the time
    client.more('sphere/pose')
    paused = client.call_async('pause', SetBool, data=True)
    stepped = client.call_async('step', Trigger)
    client.wait(lambda: paused.done() and stepped.done())
    tick = int(paused.result().message.split()[3].rstrip(','))
    assert stepped.result().message.startswith(f'tick {tick + 1}, ')


def test_reset_begins_anew(client):
    client.pause()
    epoch = int(client.reset().message.split()[1].rstrip(','))
    client.drain()
    client.clear()
    expected = [message.pose for message in client.steps(5, 'sphere/pose')]
    client.set_group({'gravity': 1.0, 'hand.position': [1.0, 1.0, 1.0], 'sphere.mass': 3.0,
                      'integrator': 'semi_implicit_euler', 'rate': 200.0, 'step': 0.002})
    client.publish('hand/command', PointStamped())
    client.steps(3, 'sphere/pose')
    client.clear()
    response = client.reset()
    assert (response.success, response.message) == (True, f'epoch {epoch + 1}, tick 0, 0 s')
    client.wait(lambda: client.heard['epoch'])
    client.drain()
    assert client.last('epoch').data == epoch + 1
    assert stamps(client.messages('sphere/pose')) == [0]
    assert client.get('gravity', 'sphere.mass', 'integrator', 'rate', 'step') == [
        9.81, 1.0, 'auto', 100.0, 0.001]
    assert list(client.get('hand.position')[0]) == [0.0, 0.0, 2.0]
    message, values = told(client)
    assert (message, values['epoch'], values['tick']) == ('paused', str(epoch + 1), '0')
    client.clear()
    assert [message.pose for message in client.steps(5, 'sphere/pose')] == expected


def test_reset_of_a_running_node_keeps_it_running(client):
    client.more('sphere/pose', 3)
    client.reset()
    client.wait(lambda: client.last('sphere/pose').header.stamp.sec == 0)
    times = stamps(client.messages('sphere/pose'))
    assert times.count(0) >= 1
    client.more('sphere/pose', 3)


def test_two_resets_in_a_row(client):
    first, second = client.reset(), client.reset()
    epochs = [int(answer.message.split()[1].rstrip(',')) for answer in (first, second)]
    assert epochs[1] == epochs[0] + 1


def test_every_service_answers_at_full_speed(client):
    client.configure({'real_time_factor': 0.0})
    assert client.reset().success
    assert client.pause().success
    assert client.step().success
    assert client.configure({'gravity': 9.0})[0].successful
    assert client.pause(False).success
    assert not client.step().success
    assert client.pause().success
    client.configure({'real_time_factor': 1.0})
    client.drain()
    assert client.last('sphere/pose').header.stamp.sec >= 0


def test_a_late_subscriber_learns_the_epoch(client):
    client.pause()
    epoch = client.reset().message.split()[1].rstrip(',')
    client.clear()
    client.listen({'epoch': EPOCH}, LATCHED)
    client.wait(lambda: client.heard['epoch'])
    assert str(client.last('epoch').data) == epoch
