# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The example of a controller, beside a node."""

import re
import sys

from tree import output_of, ROOT


def test_energy_falls_faster_with_it(start):
    start('-p', 'real_time_factor:=1.5')
    text = output_of([sys.executable, ROOT / 'examples' / 'damp_sphere.py', '--duration', 3])
    alone, damped = (float(energy) for energy in re.findall(r'([\d.]+) J above rest', text))
    # 0.8 J and 0.2 J; how soon each force is heard depends on the machine
    assert 0.6 < alone < 1.0 and 0.0 < damped < 0.5 * alone
