# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bags of earlier runs that were interrupted, recovered while this one goes on."""

import os
from pathlib import Path
import subprocess
import sys
import threading

from ..bag.recovery.interrupted import interrupted_bags

# More are left for the next start.
_MOST = 1000
# Ticks come first.
_NICENESS = 5
# It goes on by itself after the node has ended, which waits so long to be able to tell of it [s].
_FAREWELL = 2.0


class Recovering:
    """
    Has what was interrupted in a folder recovered by a process of its own.

    log: the node's, which is told what comes of it.
    """

    def __init__(self, folder, log):
        self._thread = None
        paths = interrupted_bags(Path(folder).expanduser())[:_MOST]
        if not paths:
            return
        log.warning(f'{len(paths)} bag(s) in {folder} were interrupted: recovering')
        # Not in the terminal's group of processes: Ctrl-C is for the node.
        process = subprocess.Popen(
            [sys.executable, '-m', 'dynsim_ros.cli.recover', *map(str, paths)],
            env={**os.environ, 'PYTHONPATH': os.pathsep.join(filter(None, sys.path))},
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
            start_new_session=True)
        os.setpriority(os.PRIO_PROCESS, process.pid, _NICENESS)
        self._thread = threading.Thread(target=_listen, args=(process, log), name='recovering',
                                        daemon=True)
        self._thread.start()

    def end(self):
        """Wait a moment for it to be done."""
        if self._thread is not None:
            self._thread.join(_FAREWELL)


def _listen(process, log):
    """Log what a process tells, until it ends."""
    for line in process.stdout:
        (log.error if line.startswith('error: ') else log.info)(line.rstrip())
    process.wait()
