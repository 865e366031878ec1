# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What of a bag is wanted: options that several programs have in common."""

from __future__ import annotations

import argparse
import math
import sys


def add_selection(parser: argparse.ArgumentParser):
    """Add --topics, --start and --end."""
    add = parser.add_argument
    add('--topics', nargs='+', action='extend', default=[], metavar='TOPIC',
        help="only these topics; * and ? stand for any text, the node's name may be left out "
             '(default: all)')
    add('--start', type=_seconds, metavar='SECONDS',
        help="only from this time on, in simulated time; of others' bags since the first message "
             '(default: the beginning)')
    add('--end', type=_seconds, metavar='SECONDS', help='only up to this time (default: the end)')


def load_selection(options: argparse.Namespace, path: str):
    """Return what is wanted of a bag as a LoadedRun, after warnings; raise ValueError."""
    from ..bag import load

    if None not in (options.start, options.end) and options.start > options.end:
        raise ValueError(f'--start {options.start:g} s lies behind --end {options.end:g} s')
    run = load(path, options.topics, options.start, options.end)
    if run.problem:
        print(f'warning: {run.problem}', file=sys.stderr)
    return run


def _seconds(text: str) -> float:
    """Return a finite number of seconds."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not abs(value) <= 1e9:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number of seconds up to 1e9")
    return value
