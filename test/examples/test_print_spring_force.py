# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The example of a subscriber, beside a node."""

import re
import sys

from scene_topics import NATURAL_LENGTH, STIFFNESS
from tree import output_of, ROOT


def test_it_prints_the_force_ten_times_a_second(start):
    node = start()
    text = output_of(
        [sys.executable, ROOT / 'examples' / 'print_spring_force.py', '--count', 4])
    number = r' +([+-]?\d+\.\d+)'
    lines = [re.fullmatch(f'{number} s {3 * number} N  .F.{number} N', line)
             for line in text.splitlines()]
    times, forces = zip(*[(float(line.group(1)), float(line.group(5))) for line in lines])
    assert [round(b - a, 6) for a, b in zip(times, times[1:])] == [0.1, 0.1, 0.1]
    # the spring is never longer than its natural length by as much again
    assert 0.0 < max(forces) < STIFFNESS * NATURAL_LENGTH
    # the node itself says nothing where there is no terminal
    assert node.stop() == ''
