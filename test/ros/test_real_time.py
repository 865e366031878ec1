# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is asked of the operating system is had, or a line says that it is not granted."""

import os
from pathlib import Path
import subprocess
import sys

from live_node import start_refused, with_parameters
import pytest
from scene_topics import POSE


FIFO = os.SCHED_FIFO | os.SCHED_RESET_ON_FORK


def tasks(node):
    return [int(path.name) for path in Path(f'/proc/{node.process.pid}/task').iterdir()]


def test_all_of_it(start, connect):
    cpu = max(os.sched_getaffinity(0))
    node = start(*with_parameters({
        'rate': 1000.0, 'integrator': 'rk4', 'real_time.spin': 5e-5, 'real_time.priority': 20.0,
        'real_time.cpu': cpu, 'real_time.lock_memory': 'true'}))
    client = connect(node)
    client.listen({'sphere/pose': POSE})
    client.more('sphere/pose', 100)
    (only,) = [task for task in tasks(node) if len(os.sched_getaffinity(task)) == 1] if len(
        os.sched_getaffinity(0)) > 1 else [None]
    assert only is None or os.sched_getaffinity(only) == {cpu}
    first = [task for task in tasks(node) if os.sched_getscheduler(task) == FIFO]
    assert first == [only] if first and only else first or (
        'real_time.priority: 20 is not granted' in node.output)
    status = Path(f'/proc/{node.process.pid}/status').read_text()
    (locked,) = [line.split()[1] for line in status.splitlines() if line.startswith('VmLck')]
    assert locked != '0' or 'real_time.lock_memory: is not granted' in node.output
    node.stop()


def first_of_all(node):
    """Return how many threads of a node have the lowest priority of SCHED_FIFO."""
    return sum(os.sched_getscheduler(task) == FIFO and os.sched_getparam(task).sched_priority == 1
               for task in tasks(node))


def is_permitted():
    """Tell whether a process may have that here."""
    trial = 'import os; os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))'
    return not subprocess.run([sys.executable, '-c', trial], stderr=subprocess.DEVNULL,
                              check=False).returncode


def test_the_ticking_thread_goes_first_while_it_mostly_sleeps(start, connect):
    node = start('-p', 'rate:=1000.0', '-p', 'integrator:=rk4')
    client = connect(node)
    client.listen({'sphere/pose': POSE})
    expected = is_permitted()
    client.wait(lambda: first_of_all(node) == expected)
    client.configure({'real_time_factor': 0.0})
    client.wait(lambda: first_of_all(node) == 0)
    client.configure({'real_time_factor': 1.0})
    client.wait(lambda: first_of_all(node) == expected)
    assert 'real_time.priority' not in node.output
    node.stop()


@pytest.mark.parametrize('option', ['real_time.spin:=0.001', 'real_time.priority:=0.0'])
def test_it_does_not_where_it_waits_busily_or_is_told_not_to(start, connect, option):
    node = start('-p', 'rate:=1000.0', '-p', 'integrator:=rk4', '-p', option)
    client = connect(node)
    client.listen({'sphere/pose': POSE})
    client.more('sphere/pose', 500)
    assert first_of_all(node) == 0
    node.stop()


def turn(task):
    """Return how long a turn of a thread is before another one has its own [ns]."""
    lines = Path(f'/proc/{task}/sched').read_text().splitlines()
    return next((int(line.split()[-1]) for line in lines if line.startswith('se.slice')), None)


def test_the_ticking_thread_has_short_turns(start, connect):
    node = start('-p', 'integrator:=rk4', '-p', 'real_time.priority:=0.0')
    client = connect(node)
    client.listen({'sphere/pose': POSE})
    client.more('sphere/pose', 3)
    turns, usual = sorted(filter(None, map(turn, tasks(node)))), turn(os.getpid())
    node.stop()
    # systems before Linux 6.12 do not tell, and have all turns alike
    assert not turns or turns[0] == 100_000 and set(turns[1:]) == {usual}


def test_a_processor_that_does_not_exist(start, connect):
    node = start('-p', 'real_time.cpu:=1000.0', '-p', 'integrator:=rk4')
    client = connect(node)
    client.listen({'sphere/pose': POSE})
    client.more('sphere/pose', 3)
    assert 'real_time.cpu: 1000 is not possible' in node.output


def test_out_of_range(tmp_path):
    assert 'real_time.spin' in start_refused(tmp_path, '-p', 'real_time.spin:=1.0')
