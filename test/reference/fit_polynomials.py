# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Fit the polynomials of the elementary functions: python fit_polynomials.py prints them.

Each is a power series, fitted by Chebyshev's polynomials: that comes near to the smallest largest
error. Beside that is the error after rounding the coefficients to double precision, as a logarithm
to base 2; of the function it makes as much as the power of z or r before it.
"""

from mpmath import chebyfit, fac, linspace, log, mp, mpf, pi, polyval, sqrt, tan

DIGITS, SERIES, SAMPLES = 40, 40, 500
with mp.workdps(DIGITS):
    EIGHTH = 1.0001 * pi / 4
    HALF_OCTAVE = 1.0001 * log(2) / 2
    STEEPEST, FLATTEST = 1.0001 * tan(pi / 8) ** 2, -1.0001 * (3 - 2 * sqrt(2)) ** 2
# Name, interval, count of coefficients, coefficient n of the power series.
FITS = {
    # sin(x) = x + x z S(z), cos(x) = 1 - z / 2 + z z C(z); z = x x
    'SINE': (0, EIGHTH ** 2, 7, lambda n: (-1) ** (n + 1) / fac(2 * n + 3)),
    'COSINE': (0, EIGHTH ** 2, 6, lambda n: (-1) ** n / fac(2 * n + 4)),
    # exp(r) = 1 + r + r r E(r)
    'EXPONENTIAL': (-HALF_OCTAVE, HALF_OCTAVE, 11, lambda n: 1 / fac(n + 2)),
    # arctan(r) = r + r z A(z), artanh(r) = r - r z A(-z); z = r r
    'ARCTANGENT': (FLATTEST, STEEPEST, 13, lambda n: mpf(-1) ** (n + 1) / (2 * n + 3)),
}


def fitted(name):
    """Return the coefficients of one of FITS as floats, that of degree 0 first, and their error."""
    with mp.workdps(DIGITS):
        lowest, highest, count, coefficient = FITS[name]
        series = [coefficient(n) for n in range(SERIES)][::-1]
        rounded = [float(number) for number in chebyfit(lambda z: polyval(series, z),
                                                        [lowest, highest], count)]
        error = max(abs(polyval(rounded, z) - polyval(series, z))
                    for z in linspace(lowest, highest, SAMPLES))
        return tuple(rounded[::-1]), float(log(error, 2))


if __name__ == '__main__':
    for polynomial in FITS:
        numbers, worst = fitted(polynomial)
        print(f'{polynomial}: 2^{worst:.1f}', *numbers, sep='\n    ')
