# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the benchmarks of the node measure with, and a short soak."""

import os
import signal
import sys
import time

from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import Simulator
import numpy as np
import pytest
from tree import output_of, ROOT

BENCHMARKS = ROOT / 'benchmarks'


@pytest.fixture
def naive_node(monkeypatch):
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    import naive_node
    return naive_node


@pytest.fixture
def measuring(monkeypatch):
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    import node_processes
    import soak
    return node_processes, soak


def test_the_naive_node_simulates_the_same(naive_node):
    ours = Simulator(load_scene('sphere_on_spring'), rate=1000.0)
    x, v, q, omega = (part('sphere')[0] for part in parts(ours.run(0.001)))
    state = [*x, *v, *q, *omega]
    for _ in range(1000):
        state = naive_node.rk4(state, 0.001, (0.0, 0.0, 2.0))
    ends = parts(Simulator(load_scene('sphere_on_spring'), rate=1000.0).run(1.0))
    np.testing.assert_allclose(
        state, np.concatenate([part('sphere')[-1] for part in ends]), atol=1e-7)


def parts(run):
    return run.position, run.velocity, run.orientation, run.angular_velocity


def test_a_subscriber_that_keeps_up_misses_nothing():
    """What a busy machine makes it miss at first comes again: publishers keep all of it."""
    text = output_of([sys.executable, BENCHMARKS / 'soak.py', '--duration', 4, '--depth', 8000])
    assert text.endswith('\nno message lost, no tick missing, memory flat\n')


def test_what_is_lost_is_told(discovery, measuring):
    """A subscriber is stopped for longer than publishers keep messages."""
    processes, soak = measuring
    with processes.running('ours', 1000) as node, processes.listening(node) as subscriber:
        subscriber.begin(4.0, 1000)
        time.sleep(0.5)
        os.kill(subscriber.pid, signal.SIGSTOP)
        # 2500 messages are published meanwhile; 1000 are kept, and the sockets hold some more.
        time.sleep(2.5)
        os.kill(subscriber.pid, signal.SIGCONT)
        faults = soak.faults([subscriber.end()], 4.0)
    assert any('sphere/pose: ' in fault for fault in faults), faults
