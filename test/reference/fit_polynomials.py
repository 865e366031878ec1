# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Fit the polynomials of the elementary functions: python fit_polynomials.py prints them.

Each is a power series, fitted by Chebyshev's polynomials: that comes near to the smallest largest
error. Beside that is the error after rounding the coefficients to double precision, as a logarithm
to base 2; of the function it makes as much as the power of z or r before it.
"""

from mpmath import cos, fac, linspace, log, lu_solve, matrix, mp, mpf, pi, sqrt, tan

DIGITS, SERIES, SAMPLES = 40, 40, 200
with mp.workdps(DIGITS):
    EIGHTH = 1.0001 * pi / 4
    HALF_OCTAVE = 1.0001 * log(2) / 2
    STEEPEST, FLATTEST = 1.0001 * tan(pi / 8) ** 2, -1.0001 * (3 - 2 * sqrt(2)) ** 2
# Name, interval, count of coefficients, coefficient n of the power series.
FITS = {
    # sin(x) = x + x z S(z), cos(x) = 1 - z / 2 + z z C(z); z = x x
    'SINE': (0, EIGHTH ** 2, 7, lambda n: (-1) ** (n + 1) / fac(2 * n + 3)),
    'COSINE': (0, EIGHTH ** 2, 6, lambda n: (-1) ** n / fac(2 * n + 4)),
    # exp(r) = 1 + r + r r / 2 + r r r E(r)
    'EXPONENTIAL': (-HALF_OCTAVE, HALF_OCTAVE, 10, lambda n: 1 / fac(n + 3)),
    # arctan(r) = r + r z A(z), artanh(r) = r - r z A(-z); z = r r
    'ARCTANGENT': (FLATTEST, STEEPEST, 13, lambda n: mpf(-1) ** (n + 1) / (2 * n + 3)),
}


def value(coefficients, z):
    """Return a polynomial at z, to DIGITS."""
    return sum(coefficient * z ** n for n, coefficient in enumerate(coefficients))


def fitted(name):
    """Return the coefficients of one of FITS as floats, of degree 0 first, and their error."""
    with mp.workdps(DIGITS):
        lowest, highest, count, coefficient = FITS[name]
        series = [coefficient(n) for n in range(SERIES)]
        # At the zeros of Chebyshev's polynomial nothing is left.
        zeros = [(lowest + highest + (highest - lowest) * cos(pi * (i + 0.5) / count)) / 2
                 for i in range(count)]
        found = lu_solve(matrix([[z ** n for n in range(count)] for z in zeros]),
                         matrix([value(series, z) for z in zeros]))
        rounded = [float(number) for number in found]
        error = max(abs(value(rounded, z) - value(series, z))
                    for z in linspace(lowest, highest, SAMPLES))
        return rounded, float(log(error, 2))


if __name__ == '__main__':
    for polynomial in FITS:
        numbers, worst = fitted(polynomial)
        print(f'{polynomial}: 2^{worst:.1f}', *numbers, sep='\n    ')
