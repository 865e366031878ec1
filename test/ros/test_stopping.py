# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""However a node ends, it ends well: status 0, no traceback, a finished bag."""

import signal
import time

from live_node import with_parameters
from mcap.reader import make_reader
import pytest
from scene_topics import POSE

RECORDING = with_parameters({'record.enable': 'true'})


@pytest.fixture(scope='module', autouse=True)
def near(discovery):
    """Start no node without the settings that tests start nodes with."""


def wait_for(condition, timeout=30.0):
    limit = time.monotonic() + timeout
    while not condition():
        assert time.monotonic() < limit
        time.sleep(0.01)


def statistics(node):
    """Return the statistics of a node's only bag, from the index at its end."""
    (path,) = node.bags
    with open(path, 'rb') as stream:
        return make_reader(stream).get_summary().statistics


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_a_signal(start, number):
    node = start(*RECORDING, '-p', 'rate:=1000.0')
    wait_for(lambda: node.bags and node.bags[0].stat().st_size > 250_000)
    output = node.stop(number)
    assert f'{statistics(node).message_count} messages in runs/' in output
    assert statistics(node).message_end_time > 100_000_000


def test_impatience(start):
    node = start(*RECORDING)
    wait_for(lambda: 'recording to' in node.output)
    for number in (signal.SIGINT, signal.SIGINT, signal.SIGTERM):
        node.process.send_signal(number)
    node.wait()
    assert statistics(node).message_count > 0


def test_a_signal_while_it_runs_at_full_speed(start):
    node = start(*RECORDING, '-p', 'real_time_factor:=0.0')
    wait_for(lambda: node.bags and node.bags[0].stat().st_size > 100_000)
    assert ' lost' not in node.stop()
    assert statistics(node).message_end_time > 10 ** 9


def test_a_signal_in_the_middle_of_the_start(start):
    node = start()
    # the handler is there before anything that takes long
    wait_for(lambda: (int(signals(node)['SigCgt'], 16) >> (signal.SIGTERM - 1)) & 1)
    node.stop(signal.SIGTERM)


def signals(node):
    with open(f'/proc/{node.process.pid}/status') as stream:
        return dict(line.split(':\t', 1) for line in stream.read().splitlines())


def test_a_paused_node(start, connect):
    node = start(*RECORDING)
    client = connect(node)
    client.listen({'sphere/pose': POSE})
    client.more('sphere/pose')
    client.pause()
    node.stop()
    assert statistics(node).message_count > 0


@pytest.mark.parametrize(('given', 'ticks'), [
    ({'duration': 0.5}, 50), ({'duration': 0.499}, 50),
    ({'duration': 3, 'rate': 7, 'real_time_factor': 10}, 21),
    ({'duration': 20, 'real_time_factor': 0}, 2000)])
def test_duration(start, given, ticks):
    node = start(*RECORDING, *with_parameters(given), options=['--status'])
    output = node.wait()
    found = statistics(node)
    period = round(1e9 / given.get('rate', 100))
    assert (found.message_start_time, found.message_end_time) == (0, ticks * period)
    with open(node.bags[0], 'rb') as stream:
        times = [message.log_time for _, _, message in make_reader(stream).iter_messages(
            topics=['/dynsim/sphere/pose'])]
    assert times == list(range(0, (ticks + 1) * period, period))
    # plain lines, as this is no terminal
    assert output.startswith('starting: ') and output.replace('\n', '').isprintable()
    assert output.splitlines()[-1].endswith(
        f'recorded {found.message_count} messages in runs/{node.bags[0].name}')


def test_the_last_state_arrives(start, connect):
    node = start('-p', 'duration:=0.5')
    client = connect(node)
    client.listen({'sphere/pose': POSE})
    node.wait()
    client.drain()
    assert client.last('sphere/pose').header.stamp.nanosec == 500_000_000
