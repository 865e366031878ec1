# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What programs draw on a terminal, and that they draw nothing anywhere else."""

import fcntl
from io import StringIO
import os
import pty
import re
import signal
import struct
import subprocess
import sys
import termios

from dynsim_ros.cli.simulate import main as simulate
from live_node import with_parameters
import pytest
from tree import ROOT

COLUMNS = 60
# Goes wrong within a second, and stays as it is then.
DIVERGING = {'integrator': 'explicit_euler', 'step': 0.01, 'spring.stiffness': 1e6}
BAR = r'\[#*\.*\] +\d+%  \d\.\d of 2\.0 s'
SIMULATE = ('simulate', 'sphere_on_spring', '-d', '2', '--set', 'integrator=rk4', '-o')
REPLAY = ('replay', 'run.mcap', '--topics', '/dynsim/*', '--wait', '0', '--wait-acked', '0')


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv('FASTRTPS_DEFAULT_PROFILES_FILE',
                       str(ROOT / 'config' / 'fastdds_one_machine.xml'))
    # says how wide a terminal is, before that itself is asked
    monkeypatch.delenv('COLUMNS', raising=False)


def sim_node(values, *options):
    """Return the words of a command."""
    return 'sim_node', *options, '--ros-args', *with_parameters(values)


def module(program, *arguments):
    return [sys.executable, '-m', f'dynsim_ros.cli.{program}', *arguments]


def on_terminal(*words, until=None):
    """
    Run a program on a terminal; return its exit status and all that it wrote there.

    until: what it is asked to end by Ctrl-C after, an expression.
    """
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack('4H', 24, COLUMNS, 0, 0))
    # Beside os.environ there may be a COLUMNS that a module written in C has put there.
    process = subprocess.Popen(module(*words), stdin=theirs, stdout=theirs, stderr=theirs,
                               env=dict(os.environ))
    os.close(theirs)
    written = ''
    while data := read(ours):
        written += data
        if until and re.search(until, written):
            process.send_signal(signal.SIGINT)
            until = None
    os.close(ours)
    return process.wait(60), written.replace('\r\n', '\n')


def read(terminal):
    """Return what was written to a terminal, nothing once no program has it any more."""
    try:
        return os.read(terminal, 65536).decode()
    except OSError:
        return ''


def rows(text):
    """Return what is left to see: of each row, the text since it was last cleared."""
    plain = re.sub('\x1b\\[[0-9]*m', '', text)
    shown = [row.rpartition('\r\x1b[K')[2] for row in plain.split('\n')]
    assert not any('\x1b' in row or '\r' in row for row in shown), shown
    return shown


def drawn(text):
    """Return the lines that were drawn one over the other."""
    return re.findall('\r\x1b\\[K([^\r\n\x1b]+)', text)


def test_the_status_line_of_the_node_and_what_it_logs_beside_it():
    status, text = on_terminal(*sim_node(DIVERGING), until='diverged  t ')
    assert status == 0
    lines = drawn(text)
    assert lines[0].startswith('starting: ') and max(map(len, lines)) == COLUMNS - 1
    first, logged, last, nothing = rows(text)
    assert first == lines[0] and last == lines[-1] and nothing == ''
    assert re.match(r'\[ERROR\] \[[\d.]+\] \[dynsim\]: paused: ', logged), logged
    assert last.startswith('diverged  t ')


def test_an_error_at_the_start_of_the_node():
    status, text = on_terminal(*sim_node({'sphere.mass': -1.0}))
    assert status == 2
    assert rows(text)[1:] == ['error: sphere.mass: -1 kg is out of range: 1e-09 to 1e+06 kg', '']


def test_a_quiet_node():
    assert on_terminal(*sim_node({'integrator': 'rk4', 'duration': 0.1}, '--quiet')) == (0, '')


def test_simulate_and_replay_draw_a_bar():
    status, text = on_terminal(*SIMULATE, 'run.mcap')
    assert (status, any(re.match(BAR, line) for line in drawn(text))) == (0, True)
    heading, result, nothing = rows(text)
    assert (heading, nothing) == ('sphere_on_spring: 2 s with rk4 at 100 Hz', '')
    assert re.match(r'2 s simulated in .* messages in run\.mcap', result)
    status, text = on_terminal(*REPLAY, '--rate', '10')
    assert (status, any(re.match(BAR, line) for line in drawn(text))) == (0, True)
    assert [row.partition(' ')[0] for row in rows(text)] == ['run.mcap:', 'replayed', '']


class Terminal(StringIO):
    """What a program takes for a terminal, within this process."""

    def isatty(self):
        return True


def test_simulate_that_is_not_looked_at(capsys):
    assert simulate([*SIMULATE[1:], 'run.mcap']) == 0
    written = capsys.readouterr()
    first, second = written.out.splitlines()
    assert (first + second).isprintable() and written.err == ''


def test_a_quiet_simulate(monkeypatch):
    monkeypatch.setattr(sys, 'stdout', Terminal())
    assert simulate([*SIMULATE[1:], 'quiet.mcap', '--quiet']) == 0
    assert sys.stdout.getvalue() == ''
    assert simulate([*SIMULATE[1:], 'loud.mcap']) == 0
    assert drawn(sys.stdout.getvalue())
