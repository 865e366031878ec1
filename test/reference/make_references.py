# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Write references.json: where the bodies of each scene are, to 24 decimals.

    pip install heyoka gmpy2 numba numpy PyYAML
    PYTHONPATH=.:test:test/reference python test/reference/make_references.py [SCENE ...]

The scenes are those of scenes.yaml and those of the package. Each is solved twice, by heyoka and
by extrapolation, with other variables and other code (by_heyoka.py, by_extrapolation.py). Nothing
is written unless the two agree to AGREEMENT in every part; what is written is heyoka's. Beside
the motions stands by how much the two differ at most, and the amplification: how many times
larger an error of 1e-20 in any one of the initial values becomes, at worst, at one of the times.
Takes half an hour for all of them.
"""

import json
import re
import sys

from by_extrapolation import ByExtrapolation
from by_heyoka import ByHeyoka, rotation
import gmpy2
from heyoka import real128
import numpy as np
from references import all_scenes, FILE

AGREEMENT = 1e-24
NUDGE = '1e-20'
# Shorter [s] where the motion is chaotic, or for the sake of the time that a test takes.
DURATIONS = {'S3q': 2.0, 'S3q8': 0.2, 'S3b': 2.0, 'S3b8': 0.2,
             'double_pendulum_of_spheres': 1.0, 'fast_ball': 5.0,
             'four_bodies': 5.0, 'pulling_at_each_other': 2.0, 'spinning_box': 4.0,
             'stiff_box': 5.0, 'stiff_pair': 2.0, 'stiff_towed': 5.0, 'strong_damper': 5.0}
USUAL_DURATION = 10.0
TIMES = 5


def exact(values):
    """Return numbers of heyoka as numbers of gmpy2."""
    return np.vectorize(lambda value: gmpy2.mpfr(str(value)), otypes=[object])(values)


def with_matrices(motion):
    """Return a motion by heyoka as one by extrapolation: {body: (r, v) or (r, v, R, omega)}."""
    return {name: (exact(r), exact(v), *((exact(rotation(turning[0])), exact(turning[1]))
                                         if turning else ()))
            for name, (r, v, *turning) in motion.items()}


def distance(first, second):
    """Return the largest difference of a part of two motions, over max(1, its size)."""
    largest = 0.0
    for name, parts in second.items():
        for part, other in zip(first[name], parts):
            size = gmpy2.sqrt(np.sum(other ** 2))
            # two rotations by their angle: |R - S| is the root of 8 times the sine of its half
            size = np.sqrt(2.0) if other.ndim == 2 else max(1, size)
            largest = max(largest, float(gmpy2.sqrt(np.sum((part - other) ** 2)) / size))
    return largest


def amplification(heyoka, times, motions):
    """Return how much a small error of an initial value grows, at worst."""
    worst = 0.0
    for i, value in enumerate(heyoka.start):
        start = [*heyoka.start]
        start[i] = value + real128(NUDGE)
        for motion, other in zip(heyoka.solve(times, start), motions):
            worst = max(worst, distance(with_matrices(motion), other) / float(NUDGE))
    return worst


def text(value):
    """Return a number as text, to 24 decimals."""
    found = f'{gmpy2.mpfr(str(value)):.24f}'.rstrip('0').rstrip('.')
    return '0' if found == '-0' else found


def reference(name, scene):
    """Solve a scene both ways; return what is written of it."""
    duration = DURATIONS.get(name, USUAL_DURATION)
    # such that the times are whole milliseconds, and the closest doubles of what they look like
    times = [round(duration * part / TIMES, 3) for part in range(1, TIMES + 1)]
    other, heyoka = ByExtrapolation(scene).solve(times), ByHeyoka(scene)
    found = heyoka.solve(times)
    motions = [with_matrices(motion) for motion in found]
    agreement = max(map(distance, motions, other))
    assert agreement < AGREEMENT, f'{name}: differ by {agreement:.1e}'
    worst = amplification(heyoka, times, motions)
    print(f'{name}: {duration:g} s, agreement {agreement:.1e}, amplification {worst:.1e}',
          flush=True)
    return {'times': times, 'agreement': float(f'{agreement:.1e}'),
            'amplification': float(f'{worst:.1e}'),
            'motions': [{body: [[text(value) for value in part] for part in parts]
                         for body, parts in motion.items()} for motion in found]}


def as_json(references):
    """Return JSON, each list of numbers in one line."""
    return re.sub(r'\[([^][{}]*)\]', lambda found: f"[{' '.join(found.group(1).split())}]",
                  json.dumps(references, indent=1)) + '\n'


def main(names):
    """Solve the scenes named, or all; keep what is written of the others."""
    scenes = all_scenes()
    written = json.loads(FILE.read_text(encoding='utf-8')) if names else {}
    for name in names or scenes:
        written[name] = reference(name, scenes[name])
        FILE.write_text(as_json({name: written[name] for name in scenes if name in written}),
                        encoding='utf-8')


if __name__ == '__main__':
    main(sys.argv[1:])
