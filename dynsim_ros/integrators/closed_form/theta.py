# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Jacobi's theta functions: sums of four terms, on which the free rotation of a body rests.

Each has a trigonometric series in the nome q = exp(-pi K' / K) and a hyperbolic one in
q' = exp(-pi K / K'). Used is the one whose nome is at most exp(-pi): what is left out is below
1e-16 of the sum. Towards modulus 1 (separatrix) the terms of the hyperbolic one vanish, and it
keeps its relative accuracy.

Source: DLMF 20.2 (series), 20.7.30-33 (from one nome to the other), 22.2.4-9 (sn, cn, dn).
Phase: the argument of theta_4(x + i B) (trigonometric) or of theta_2(beta - i x) (hyperbolic).
"""

import math

from ...physics.elementary import exponential, sine_cosine
from ...physics.jit import formula


@formula
def square_and_cube(c, s):
    """Return real and imaginary parts of (c + i s)^2 and (c + i s)^3."""
    c2, s2 = c * c - s * s, 2.0 * c * s
    return c2, s2, c * c2 - s * s2, s * c2 + c * s2


@formula
def trigonometric_ratio(q):
    """Return theta_3(0) / theta_4(0): the complementary modulus to the power -1/2."""
    q4 = q * q * q * q
    even, odd = 1.0 + 2.0 * q4, 2.0 * q * (1.0 + q4 * q4)
    return (even + odd) / (even - odd)


@formula
def trigonometric_phase(q, more, less):
    """
    Return coefficients for even and odd terms, and the slope of the phase at x = 0.

    more, less: q exp(2 B) and q exp(-2 B).
    """
    q2 = q * q
    q6 = q2 * q2 * q2
    m2, l2 = q2 * more * more, q2 * less * less
    m3, l3 = q6 * more * more * more, q6 * less * less * less
    even = (1.0, -(more + less), m2 + l2, -(m3 + l3))
    odd = (0.0, more - less, l2 - m2, m3 - l3)
    slope = 2.0 * odd[1] + 4.0 * odd[2] + 6.0 * odd[3]
    return even, odd, slope / (even[0] + even[1] + even[2] + even[3])


@formula
def trigonometric(x, q, ratio, even, odd):
    """
    Return tan(amplitude) as numerator and denominator, the phase as real and imaginary part.

    |x| <= pi / 2 (u = K); q, ratio, even, odd: from the functions above.
    """
    sine, cosine = sine_cosine(x)
    c1, s1 = cosine * cosine - sine * sine, 2.0 * sine * cosine
    c2, s2, c3, s3 = square_and_cube(c1, s1)
    a1 = q * q
    a2 = a1 * a1 * a1
    a3 = a2 * a2
    numerator = (sine * (1.0 - a1 * c1 + a2 * c2 - a3 * c3)
                 - cosine * (a1 * s1 - a2 * s2 + a3 * s3))
    denominator = (cosine * (1.0 + a1 * c1 + a2 * c2 + a3 * c3)
                   - sine * (a1 * s1 + a2 * s2 + a3 * s3))
    return (ratio * numerator, denominator,
            even[0] + even[1] * c1 + even[2] * c2 + even[3] * c3,
            odd[1] * s1 + odd[2] * s2 + odd[3] * s3)


@formula
def hyperbolic_ratio(q):
    """Return 2 q^(1/4) theta_3(0) / theta_2(0)."""
    q4 = q * q * q * q
    return (1.0 + 2.0 * (q + q4 + q4 * q4 * q)) / (1.0 + q * q + q4 * q * q)


@formula
def hyperbolic_phase(q, c, s):
    """Return what trigonometric_phase does; c, s: cos(beta) and sin(beta)."""
    c1, s1 = c * c - s * s, 2.0 * c * s
    c2, s2, c3, s3 = square_and_cube(c1, s1)
    q4 = q * q * q * q
    q9 = q4 * q4 * q
    even = (c, q * (c * c1 - s * s1), q4 * (c * c2 - s * s2), q9 * (c * c3 - s * s3))
    odd = (s, q * (s * c1 + c * s1), q4 * (s * c2 + c * s2), q9 * (s * c3 + c * s3))
    slope = odd[0] + q * (3.0 * odd[1] + q * (5.0 * odd[2] + q * 7.0 * odd[3]))
    return even, odd, slope / (even[0] + q * (even[1] + q * (even[2] + q * even[3])))


@formula
def hyperbolic(x, q, ratio, even, odd):
    """
    Return what trigonometric does; |x| <= pi K / (2 K') (u = K), which may be infinite.

    Numerators and denominators are divided by powers of exp(|x|): none of them overflows.
    """
    e, less = exponential(-2.0 * abs(x))
    sine = math.copysign(less, x)
    y = q / e if q > 0.0 else 0.0
    e2, e3 = e * e, e * e * e
    e4 = e2 * e2
    q2, q4 = q * q, q * q * q * q
    sum3 = 1.0 + e + e2
    sum5 = sum3 + e3 + e4
    sum7 = sum5 + e4 * e + e4 * e2
    numerator = 1.0 - y * q * (sum3 - y * q2 * q * (sum5 - y * q4 * q * sum7))
    denominator = 1.0 - y * (1.0 + e2 - y * q2 * (1.0 + e4 - y * q4 * (
        1.0 + e4 * e2 - y * q4 * q2 * (1.0 + e4 * e4))))
    real = even[0] * (1.0 + e) + y * (even[1] * (1.0 + e3) + y * (
        even[2] * (1.0 + e4 * e) + y * even[3] * (1.0 + e4 * e3)))
    imaginary = odd[0] + y * (odd[1] * sum3 + y * (odd[2] * sum5 + y * odd[3] * sum7))
    return ratio * sine * numerator, 2.0 * math.sqrt(e) * denominator, real, sine * imaginary
