# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The options that the smaller benchmarks have in common."""

import argparse
from pathlib import Path


def parse_options(doc, results, rounds):
    """Return rounds and output folder; doc: of the script; results: what it writes."""
    parser = argparse.ArgumentParser(description=doc.splitlines()[1])
    parser.add_argument('--rounds', type=int, default=rounds,
                        help=f'timed rounds (default {rounds})')
    parser.add_argument('--output', type=Path, default=Path(__file__).parent,
                        help=f'folder for {results} (default: that of this file)')
    return parser.parse_args()
