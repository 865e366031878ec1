# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Writing to a terminal, a file or a pipe that may be gone."""

from __future__ import annotations

import os
from typing import TextIO


def write(stream: TextIO, text: str):
    """
    Write a text at once; if nobody can take it any more, be silent from here on.

    Who looks at a run must not end it: `sim_node --status | head` goes on recording.
    """
    try:
        stream.write(text)
        stream.flush()
    except OSError:
        # What is still in the stream's own buffer would fail again when the program ends.
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
