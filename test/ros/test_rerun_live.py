# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A live run that two processes command at random, lived again here without ROS."""

import os
import subprocess
import sys

from dynsim_ros.cli.rerun import main as rerun
from plain import environment
from recorded import messages
from tree import ROOT

# `make rerun-grid` takes a minute.
SECONDS = 60.0 if os.environ.get('DYNSIM_RERUN_GRID') == 'all' else 2.5


def command(seed):
    """Start a process that commands; return it."""
    return subprocess.Popen(
        [sys.executable, str(ROOT / 'test' / 'commander.py'), str(seed), str(SECONDS)],
        stdout=subprocess.PIPE, text=True, env=environment())


def test_every_state_is_the_same_bits(start, connect, capsys):
    node = start('-p', 'record.enable:=true')
    commanders = [command(seed) for seed in (1, 2)]
    client = connect(node)
    # a bag that begins while all is going on
    client.wait(lambda: 'recording to' in node.output
                and client.node.count_publishers('/dynsim/hand/command'))
    client.record(False)
    client.record(True)
    counts = [int(commander.communicate()[0]) for commander in commanders]
    assert [commander.returncode for commander in commanders] == [0, 0] and min(counts) > 10
    node.stop()
    first, second = node.bags
    for path in (first, second):
        assert rerun([str(path)]) == 0
        assert capsys.readouterr().out.startswith('identical, ')
    recorded = messages(second)
    assert len(recorded['/dynsim/hand/command']) > 3
    assert len(recorded['/dynsim/sphere/wrench_command']) > 3
    assert len(recorded['/dynsim/state_hash']) >= SECONDS
