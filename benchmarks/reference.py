# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Reference solutions of the cases, by two methods that have nothing in common but the equations.

Usage: python benchmarks/reference.py [CASE ...]; writes reference.json beside this file (needs gcc
and heyoka). The first method is extrapolation in 113-bit arithmetic (extrapolation.c, the steps
halved until nothing changes), the second heyoka's Taylor method in 80-bit arithmetic with
tolerance 1e-19. Where their ends differ by more than 1e-13, in the error as metric.py defines it,
the case is refused. What is kept is the first one's.
"""

import argparse
import hashlib
import json
from pathlib import Path
import subprocess
import tempfile

from algebra import Numbers
from cases import CASES
from equations import rates
from metric import error
import numpy as np
from states import in_world, initial, Places, start
from symbols import Program

HERE = Path(__file__).parent
FILE = HERE / 'reference.json'
# Samples are kept, for the tests of dense output, at so many instants after the start.
SAMPLES = 20


def references():
    """Return {case: {'end': [...], 'samples': [[...]], ...}} as kept in the file."""
    return json.loads(FILE.read_text(encoding='utf-8'))


def reference_end(case):
    """Return the state at the end: (size,) longdouble; ValueError where the file is of old."""
    kept = references().get(case.name)
    if kept is None or kept['of'] != digest(case):
        raise ValueError(f'{FILE.name} has no {case.name} as it is now; make it again with '
                         f'python benchmarks/reference.py {case.name}')
    return np.array([np.longdouble(number) for number in kept['end']])


def reference_samples(case, times):
    """Return the states at times [s], the first one 0: by Taylor, checked with what is kept."""
    states = np.array([initial(case.scene), *by_taylor(case, times[1:])])
    expected = np.array(references()[case.name]['samples'])
    every = (len(times) - 1) // SAMPLES
    worst = error(case.scene, states[every::every], expected)
    if not worst < 1e-13:
        raise ValueError(f'{case.name}: the samples differ from {FILE.name} by {worst:.1g}')
    return states


def digest(case):
    """Return a digest of all that the reference of a case depends on."""
    text = repr([Program(case.scene).lines, start(case.scene).tolist(), case.duration])
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def by_extrapolation(case, steps):
    """Return (SAMPLES, size) longdouble, states at equal distances up to the end."""
    with tempfile.TemporaryDirectory() as folder:
        program = compile_rates(case.scene, Path(folder))
        text = '\n'.join(map(float.hex, start(case.scene)))
        done = subprocess.run([program, case.duration.hex(), str(steps), str(SAMPLES)],
                              input=text, capture_output=True, text=True, check=True)
    return in_world(case.scene, [[np.longdouble(number) for number in line.split()]
                                 for line in done.stdout.splitlines()])


def compile_rates(scene, folder):
    """Return the path of extrapolation.c, compiled for a scene."""
    program = Program(scene, lambda value: f'{value.hex()}Q', '1.0Q / sqrtq({})')
    size = Places(scene).size
    lines = [f'#define SIZE {size}',
             'static void rates(__float128 t, const __float128 *y, __float128 *out) {',
             *(f'__float128 y{i} = y[{i}];' for i in range(size)),
             *(f'__float128 {name} = {text};' for name, text in program.lines),
             *(f'out[{i}] = {text};' for i, text in enumerate(program.results)), '(void)t; }']
    (folder / 'rates.h').write_text('\n'.join(lines), encoding='utf-8')
    subprocess.run(['gcc', '-O2', '-fno-trapping-math', f'-I{folder}', HERE / 'extrapolation.c',
                    '-o', folder / 'program', '-lquadmath'], check=True)
    return folder / 'program'


def by_taylor(case, times):
    """Return (times, size) longdouble, by heyoka in 80-bit arithmetic."""
    import heyoka

    size = Places(case.scene).size
    y = heyoka.make_vars(*(f'y{i}' for i in range(size)))
    numbers = Numbers(lambda value: heyoka.expression(np.longdouble(value)),
                      lambda a: a ** heyoka.expression(np.longdouble(-0.5)))
    system = list(zip(y, rates(case.scene, numbers, heyoka.time, y)))
    taylor = heyoka.taylor_adaptive(system, start(case.scene).astype(np.longdouble),
                                    tol=np.longdouble('1e-19'), fp_type=np.longdouble,
                                    compact_mode=True)
    states = taylor.propagate_grid(np.array([0, *times], dtype=np.longdouble))[-1]
    return in_world(case.scene, states[1:])


def converged(case):
    """Return the states by extrapolation with enough steps, and the last change."""
    steps, before = 4, None
    while steps < 100_000:
        states = by_extrapolation(case, steps)
        if before is not None and np.isfinite(before).all():
            change = error(case.scene, before[-1], states[-1])
            if change < 1e-17:
                return states, change
        steps, before = 2 * steps, states
    raise RuntimeError(f'{case.name}: extrapolation did not converge')


def entry(case):
    """Return what the file keeps of a case."""
    states, change = converged(case)
    times = np.longdouble(case.duration) * np.arange(1, SAMPLES + 1) / SAMPLES
    difference = error(case.scene, by_taylor(case, times)[-1], states[-1])
    print(f'{case.name}: extrapolation with half the steps {change:.1g}, Taylor {difference:.1g}',
          flush=True)
    if not difference < 1e-13:
        raise RuntimeError(f'{case.name}: the methods differ by {difference:g}')
    return {'of': digest(case), 'difference_of_methods': difference,
            'end': [f'{number:.21g}' for number in states[-1]],
            'samples': [[float(number) for number in row] for row in states]}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('cases', nargs='*', default=list(CASES), metavar='CASE')
    options = parser.parse_args()
    kept = references() if FILE.exists() else {}
    for name in options.cases:
        kept[name] = entry(CASES[name])
    text = ',\n'.join(f'{json.dumps(name)}: {json.dumps(kept[name])}' for name in CASES
                      if name in kept)
    # Numbers of one case in one line: the file is for programs, but a change of it stays readable.
    FILE.write_text('{\n' + text + '\n}\n', encoding='utf-8')


if __name__ == '__main__':
    main()
