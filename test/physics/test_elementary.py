# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Elementary functions against mpmath: within a unit of the last place, compiled as plain."""

import math
from pathlib import Path

from dynsim_ros.physics import elementary
from dynsim_ros.physics.elementary import (arc_tangent, area_tangent, exponential, quarter_turns,
                                           sine_cosine)
from dynsim_ros.physics.jit import kernel
from mpmath import mp
import numpy as np
import pytest
from reference.fit_polynomials import FITS, fitted

# Of the last place; over some hundred thousand arguments it was 0.86 at most.
UNITS = 0.9
COUNT = 500


@kernel
def evaluate(x, y, out):
    """Write all functions of every x, and the angle of every (x, y), to the columns of out."""
    for i in range(x.shape[0]):
        out[i, 0], out[i, 1] = sine_cosine(x[i])
        out[i, 2], out[i, 3] = exponential(x[i])
        out[i, 4] = area_tangent(x[i])
        out[i, 5] = arc_tangent(y[i], x[i])


def compiled(x, y=None):
    """Return (n, 6) what evaluate writes for arguments (n,)."""
    x = np.asarray(x, dtype=float)
    out = np.empty((len(x), 6))
    evaluate(x, np.ones_like(x) if y is None else np.asarray(y, dtype=float), out)
    return out


def plain(x, y=1.0):
    """Return (6,) the same for one x, by the functions as plain Python."""
    return [*sine_cosine(x), *exponential(x), area_tangent(x), arc_tangent(y, x)]


def units_off(found, exact):
    """Return the largest error of some numbers in units of the last place of what is exact."""
    return max(float(abs(mp.mpf(float(a)) - b) / math.ulp(float(b)))
               for a, b in zip(found, exact, strict=True))


def some(seed, low, high):
    """Return random numbers between two others."""
    return np.random.default_rng(seed).uniform(low, high, COUNT)


def decades(seed, low, high):
    """Return random numbers of both signs whose sizes are between two powers of ten."""
    numbers = 10.0 ** some(seed, low, high)
    numbers[::2] *= -1.0
    return numbers


def near_quarter_turns():
    """Return numbers that come nearer to multiples of pi / 2 than nearly all others."""
    found = [6381956970095103.0 * 2.0 ** 797]  # the nearest of all (Muller 2016, table 11.1)
    with mp.workprec(2400):
        quarter, rest = mp.pi / 2, mp.pi / 2
        p, p_before, q, q_before = mp.floor(rest), 1, 1, 0
        while p < mp.mpf(2) ** 1000:
            nearest = float(p)
            found += [nearest, np.nextafter(nearest, 0.0), float(q * quarter)]
            rest = 1 / (rest - mp.floor(rest))
            p, p_before = mp.floor(rest) * p + p_before, p
            q, q_before = mp.floor(rest) * q + q_before, q
    return np.array(found)


LIMITS = [math.pi / 4, 2.0 ** 26, math.log(2) / 2, 1.5 * math.log(2), 709.78, 709.0, -708.4,
          -745.0, 60.5 * math.log(2), -60.5 * math.log(2)]
AT_LIMITS = np.array([x for limit in LIMITS for x in (
    limit, np.nextafter(limit, -1e9), np.nextafter(limit, 1e9), -limit)])
ANGLES = {'eighth': some(1, -0.8, 0.8), 'turns': some(2, -40, 40), 'small': decades(3, -300, -1),
          'moderate': decades(4, 0, 8), 'large': decades(5, 8, 22), 'huge': decades(6, 22, 308),
          'limits': AT_LIMITS, 'near': near_quarter_turns()}
EXPONENTS = {'octave': some(7, -0.35, 0.35), 'octaves': some(8, -3, 3), 'decay': some(9, -60, 0),
             'all': some(10, -708, 709), 'fading': some(11, -745, -708),
             'small': decades(12, -300, -1), 'limits': AT_LIMITS[AT_LIMITS < 709.79]}


@pytest.mark.parametrize('x', ANGLES.values(), ids=ANGLES)
def test_sine_and_cosine(x):
    found = compiled(x)
    with mp.workprec(1300 if np.abs(x).max() > 1e20 else 200):
        exact = [mp.cos_sin(number) for number in x.tolist()]
        assert units_off(found[:, 0], [s for _, s in exact]) < UNITS
        assert units_off(found[:, 1], [c for c, _ in exact]) < UNITS


@pytest.mark.parametrize('x', EXPONENTS.values(), ids=EXPONENTS)
def test_exponential(x):
    found = compiled(x)
    with mp.workprec(200):
        assert units_off(found[:, 2], map(mp.exp, x.tolist())) < UNITS
        assert units_off(found[:, 3], map(mp.expm1, x.tolist())) < UNITS


def test_area_tangent():
    x = np.concatenate([some(13, -1, 1), some(14, -0.2, 0.2), decades(15, -300, -1),
                        1.0 - 10.0 ** some(16, -15.9, -1), [1.0 - 2.0 ** -53]])
    with mp.workprec(200):
        assert units_off(compiled(x)[:, 4], map(mp.atanh, x.tolist())) < UNITS


def test_arc_tangent():
    x = np.concatenate([decades(17, -1, 1), decades(18, -300, 300), decades(19, 0, 20)])
    y = np.concatenate([decades(20, -1, 1), decades(21, -300, 300), x[2 * COUNT:]])
    y[2 * COUNT:] *= 1.0 + decades(22, -16, 0)
    with mp.workprec(200):
        exact = [mp.atan2(*pair) for pair in zip(y.tolist(), x.tolist())]
        assert units_off(compiled(x, y)[:, 5], exact) < UNITS


def test_compiled_as_plain():
    x = np.concatenate([numbers[:40] for numbers in (*ANGLES.values(), *EXPONENTS.values())])
    y = np.roll(x, 7)
    found = [plain(*pair) for pair in zip(x.tolist(), y.tolist())]
    np.testing.assert_array_equal(compiled(x, y), found)


def test_zeros_infinities_and_what_is_no_number():
    """As the C standard has it (annex F), signs of zeros included."""
    odd = [0.0, -0.0, 1.0, -1.0, 5e-324, -1e308, math.inf, -math.inf, math.nan]
    x, y = (grid.ravel() for grid in np.meshgrid(odd, odd))
    found = compiled(x, y)
    for row, numbers in zip(found, zip(x.tolist(), y.tolist())):
        np.testing.assert_array_equal(np.array(plain(*numbers)).view(np.int64)[~np.isnan(row)],
                                      row.view(np.int64)[~np.isnan(row)])
    with np.errstate(all='ignore'):
        expected = [np.sin(x), np.cos(x), np.exp(x), np.expm1(x), np.arctanh(x), np.arctan2(y, x)]
    np.testing.assert_allclose(found, np.transpose(expected), rtol=4e-16, atol=0)
    number = ~np.isnan(found)
    np.testing.assert_array_equal(np.signbit(found)[number],
                                  np.signbit(np.transpose(expected))[number])


def test_are_odd_and_even():
    x = np.concatenate([*ANGLES.values(), some(23, -1, 1)])
    found, other = compiled(x), compiled(-x)
    np.testing.assert_array_equal(other[:, 0], -found[:, 0])
    np.testing.assert_array_equal(other[:, 1], found[:, 1])
    np.testing.assert_array_equal(other[:, 4], -found[:, 4])


def test_digits_of_two_over_pi():
    digits = quarter_turns._DIGITS.tolist()
    with mp.workprec(2000):
        exact = int(mp.floor(2 / mp.pi * mp.mpf(2) ** (28 * (len(digits) - 2))))
    assert sum(digit << 28 * place for place, digit in enumerate(reversed(digits))) == exact


@pytest.mark.parametrize('name', FITS)
def test_coefficients_are_those_that_are_fitted(name):
    coefficients, error = fitted(name)
    assert error < -55
    code = ''.join(path.read_text(encoding='utf-8')
                   for path in Path(elementary.__file__).parent.glob('*.py'))
    for coefficient in coefficients:
        assert f'{abs(coefficient)!r}' in code
