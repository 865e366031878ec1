# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A program of this package that another one starts and ends."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
import signal
import subprocess
import sys

# How long the program may take to finish what it does [s].
_PATIENCE = 20.0


@contextmanager
def child(program: str, arguments: Sequence[str]) -> Iterator[subprocess.Popen]:
    """
    Run a program of this package as long as the block lasts; it is then asked to end.

    In a session of its own: a Ctrl-C is for the one that started it, which ends it in turn.
    """
    process = subprocess.Popen(
        [sys.executable, '-m', f'dynsim_ros.cli.{program}', *arguments],
        stdin=subprocess.DEVNULL, start_new_session=True)
    try:
        yield process
    finally:
        if process.poll() is None:
            process.send_signal(signal.SIGTERM)
        try:
            process.wait(_PATIENCE)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
