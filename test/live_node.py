# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A simulation node in a process of its own."""

import re
import signal
import subprocess
import sys
import time

COMMAND = [sys.executable, '-m', 'dynsim_ros.cli.sim_node']


def with_parameters(values):
    """Return the ROS arguments that give parameters: {name: value as YAML}."""
    return [word for name, value in values.items() for word in ('-p', f'{name}:={value}')]


def start_refused(folder, *ros_args):
    """Start a node that has to be refused; return the one line it gives as the error."""
    done = subprocess.run([*COMMAND, '--ros-args', *map(str, ros_args)], cwd=folder,
                          capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout) == (2, ''), done.stdout + done.stderr
    assert 'Traceback' not in done.stderr, done.stderr
    (line,) = done.stderr.splitlines()
    assert line.startswith('error: '), line
    return line


def age(path):
    """Return what sorts bags by the time in their names, and the number behind that."""
    return [int(number) for number in re.findall(r'\d+', path.stem)]


class LiveNode:
    """
    A running sim_node. folder: its working directory; name: its full name.

    What it prints, log included, can be read at any time as `output`.
    """

    def __init__(self, folder, *ros_args, options=(), name='/dynsim', within=()):
        """Start the process; folder: a pathlib.Path that exists; within: command that runs it."""
        self.folder = folder
        self.name = name
        self._output = folder / f'output{name.replace("/", "_")}.txt'
        with open(self._output, 'wb') as stream:
            self.process = subprocess.Popen(
                [*within, *COMMAND, *options, '--ros-args', *map(str, ros_args)], cwd=folder,
                stdin=subprocess.DEVNULL, stdout=stream, stderr=subprocess.STDOUT)

    @property
    def output(self):
        """Return all that the process has printed."""
        return self._output.read_text(encoding='utf-8')

    @property
    def bags(self):
        """Return the paths of the bags in the default folder, oldest first."""
        return sorted(self.folder.glob('runs/*.mcap'), key=age)

    def check(self):
        """Raise AssertionError if the process has ended with an error."""
        assert not self.process.poll(), f'exit status {self.process.poll()}\n{self.output}'

    def wait(self, timeout=30.0):
        """Wait until the node ends by itself; return its output if all is well with it."""
        status = self.process.wait(timeout)
        assert status == 0, f'exit status {status}\n{self.output}'
        assert 'Traceback' not in self.output, self.output
        return self.output

    def stop(self, number=signal.SIGINT):
        """Send a signal and wait as above."""
        self.process.send_signal(number)
        return self.wait()

    def kill(self):
        """End the process if it still runs, whatever its state."""
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()

    def suspend(self, seconds):
        """Stop the process for some time, as a machine does that is short of time."""
        self.process.send_signal(signal.SIGSTOP)
        time.sleep(seconds)
        self.process.send_signal(signal.SIGCONT)
