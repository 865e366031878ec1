# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Jacobi's elliptic functions sn, cn, dn, and the phase that comes with them in a free rotation.

The theta functions are those of the modulus k_1 = (1 - k') / (1 + k'), which is smaller than k:
Landen's transformation leads from there to k (DLMF 22.7.2-4).
"""

import math
from typing import NamedTuple

from .elliptic import agm, carlson_rf
from .theta import (hyperbolic, hyperbolic_phase, hyperbolic_ratio, trigonometric,
                    trigonometric_phase, trigonometric_ratio)
from ...physics.elementary import arc_tangent, exponential, sine_cosine
from ...physics.jit import formula

# (3 - 2 sqrt(2))^2: at this complementary parameter K = 2 K', where the nomes for k_1 are equal.
_SWITCH = 0.02943725152285942
# A smaller parameter cannot be told from 0 by anything that follows from it.
_LEAST = 1e-280


class Jacobi(NamedTuple):
    """
    What is computed once for a modulus k and a phase.

    complement: k'^2; landen: 1 + k_1; inner: 1 - k_1^2; period: 2 K, and one over it, both zero
    if it is infinite; scale: from u to the argument x of the theta functions; nome to odd: as in
    theta.py; slope: of the phase against u, at u = 0; turn: what the argument of the complex
    number below lacks for each period.
    """

    hyperbolic: bool
    complement: float
    landen: float
    inner: float
    period: float
    inverse_period: float
    scale: float
    nome: float
    ratio: float
    even: tuple
    odd: tuple
    slope: float
    turn: float


@formula
def phase_height(modulus, height):
    """
    Return b >= 0 with sc(b | 1 - k_1^2)^2 = height / k_1 (DLMF 22.15(ii), 19.25.5).

    modulus: k_1 > 0.
    """
    return math.sqrt(height) * carlson_rf(modulus, modulus * (1.0 + modulus * height),
                                          modulus + height)


@formula
def trigonometric_constants(complement, landen, inner, quarter, other, height):
    """Return the Jacobi for K = quarter <= 2 K' = 2 other."""
    spread = math.pi * landen * height / quarter
    middle = 2.0 * math.pi * other / quarter
    q, _ = exponential(-middle)
    more, _ = exponential(spread - middle)
    less, _ = exponential(-spread - middle)
    even, odd, slope = trigonometric_phase(q, more, less)
    scale = 0.5 * math.pi / quarter
    return Jacobi(False, complement, landen, inner, 2.0 * quarter, 0.5 / quarter, scale, q,
                  trigonometric_ratio(q), even, odd, scale * slope, 0.0)


@formula
def hyperbolic_constants(complement, landen, inner, quarter, other, height):
    """Return the Jacobi for K = quarter >= 2 K' = 2 other; quarter may be infinite."""
    reach = 0.25 * math.pi * quarter / other
    q, _ = exponential(-2.0 * reach)
    beta = 0.25 * math.pi * landen * height / other
    sine, cosine = sine_cosine(beta)
    even, odd, slope = hyperbolic_phase(q, cosine, sine)
    ratio = hyperbolic_ratio(q)
    scale = 0.25 * math.pi / other
    period, inverse_period, turn = 0.0, 0.0, 0.0
    if quarter < math.inf:
        period, inverse_period = 2.0 * quarter, 0.5 / quarter
        _, _, real, imaginary = hyperbolic(reach, q, ratio, even, odd)
        turn = 2.0 * arc_tangent(imaginary, real)
    return Jacobi(True, complement, landen, inner, period, inverse_period, scale, q, ratio, even,
                  odd, scale * slope, turn)


@formula
def jacobi_constants(parameter, complement, height):
    """
    Return the Jacobi of parameter m = k^2 and its complement 1 - m.

    Both are given, so that each has all its digits; height: in [0, 1], (1 - c) / (1 + c) for the
    phase of the integral of 1 / (1 + c dn u).
    """
    parameter = max(parameter, _LEAST)
    root = math.sqrt(complement)
    modulus = parameter / ((1.0 + root) * (1.0 + root))
    inner = 4.0 * root / ((1.0 + root) * (1.0 + root))
    quarter = 0.5 * math.pi / agm(1.0, root) if complement > 0.0 else math.inf
    other = 0.5 * math.pi / agm(1.0, math.sqrt(parameter))
    height = phase_height(modulus, height)
    if complement >= _SWITCH:
        return trigonometric_constants(complement, 1.0 + modulus, inner, quarter, other, height)
    return hyperbolic_constants(complement, 1.0 + modulus, inner, quarter, other, height)


@formula
def circular():
    """Return the Jacobi of parameter 0: sine, cosine and 1, without a phase."""
    return Jacobi(False, 1.0, 1.0, 1.0, math.pi, 1.0 / math.pi, 1.0, 0.0, 1.0,
                  (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0), 0.0, 0.0)


@formula
def jacobi(constants, u):
    """
    Return sn u, cn u, dn u, and what the argument of a complex number falls behind slope u.

    That number is given as its real and imaginary part and a part of its argument that lies
    apart [rad]. Twice what it falls behind is the integral from 0 to u of
    A (1 / (1 + c dn) - 1 / (1 + c)), A = sqrt((1 - c^2) (1 - k'^2 c^2)) / c.
    """
    turns = math.floor(u * constants.inverse_period + 0.5)
    x = constants.scale * (u - turns * constants.period)
    if constants.hyperbolic:
        s, c, real, imaginary = hyperbolic(x, constants.nome, constants.ratio, constants.even,
                                           constants.odd)
    else:
        s, c, real, imaginary = trigonometric(x, constants.nome, constants.ratio, constants.even,
                                              constants.odd)
    # From k_1 to k: sn : cn = (1 + k_1) sn_1 : cn_1 dn_1.
    s, c = (constants.landen * s * math.sqrt(s * s + c * c),
            c * math.sqrt(c * c + constants.inner * s * s))
    size = math.sqrt(s * s + c * c)
    if 0.5 * turns != math.floor(0.5 * turns):
        size = -size
    s, c = s / size, c / size
    return (s, c, math.sqrt(c * c + constants.complement * s * s), turns * constants.turn, real,
            imaginary)
