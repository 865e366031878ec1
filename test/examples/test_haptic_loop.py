# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The example of a haptic loop, in two processes."""

import re
import sys

from tree import output_of, ROOT


def test_it_closes(discovery):
    text = output_of([sys.executable, ROOT / 'examples' / 'haptic_loop.py', '--duration', 3])
    figures = re.fullmatch(
        r'(\d+) round trips in 3 s: p50 ([\d.]+) ms, p99 ([\d.]+) ms; '
        r'the hand moved by ([\d.]+) m and felt up to ([\d.]+) N\n', text)
    trips, p50, p99, moved, felt = map(float, figures.groups())
    # How fast depends on the machine; that forces come back and move the hand does not.
    assert trips > 100 and 0.0 < p50 <= p99
    assert 0.05 < moved < 0.5
    # The sphere weighs 9.81 N; the spring, 0.4 m long beyond its natural length, pulls more.
    assert 9.81 < felt < 100.0
