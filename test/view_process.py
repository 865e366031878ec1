# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The viewer in a process of its own."""

import re
import signal
import subprocess
import sys
import time


class ViewProcess:
    """A running `view`; url: of its page."""

    def __init__(self, folder, *arguments):
        """Start it and wait for its page; folder: a pathlib.Path for what it prints."""
        self._output = folder / 'output.txt'
        with open(self._output, 'wb') as stream:
            self.process = subprocess.Popen(
                [sys.executable, '-m', 'dynsim_ros.cli.view', *map(str, arguments)], cwd=folder,
                stdin=subprocess.DEVNULL, stdout=stream, stderr=subprocess.STDOUT)
        limit = time.monotonic() + 60.0
        while (found := re.search('open (http://[^ ]+) in a browser', self.output)) is None:
            self.check()
            assert time.monotonic() < limit, self.output
            time.sleep(0.02)
        self.url = found.group(1)

    @property
    def output(self):
        """Return all that the process has printed."""
        return self._output.read_text(encoding='utf-8')

    def check(self):
        """Raise AssertionError if the process has ended."""
        assert self.process.poll() is None, self.output

    def stop(self, number=signal.SIGINT):
        """Send a signal, wait until the process has ended well; return what it printed."""
        self.process.send_signal(number)
        assert self.process.wait(30.0) == 0, self.output
        assert 'Traceback' not in self.output, self.output
        return self.output

    def kill(self):
        """End the process if it still runs, whatever its state."""
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
