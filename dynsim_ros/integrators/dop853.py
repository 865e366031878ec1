# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
One step of the Runge-Kutta method 8(5,3) of Dormand and Prince, and its dense output of order 7.

Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, II.5 and II.6.
"""

import math

from .dop853_tableau import A_AT, ALL_STAGES, C_AT, D_AT, E3_AT, E5_AT, STAGES
from .error_norm import error_norm
from .memory import DENSE_SIZE, number_row
from ..physics.jit import formula
from ..physics.lanes import COUNT
from ..physics.motion import rates
from ..physics.state import counts

# Rows of the dense output: coefficients of powers of s.
_DEGREE = 7


@formula
def stage_place(size):
    """Return where in the memory the rates of the stages begin; they take ALL_STAGES rows."""
    return (COUNT * 8 + 8) * size


@formula
def add_stages(size, data, place, count, factor, memory, out):
    """Add factor times the sum of data[place + j] k[j] over the first `count` stages to out."""
    first = stage_place(size)
    for j in range(count):
        weight = data[place + j]
        if weight != 0.0:
            weight = weight * factor
            for i in range(size):
                out[i] = out[i] + weight * memory[first + size * j + i]


@formula
def take_stages(model, drive, data, size, t, h, y, first, last, memory, stage, rate):
    """Write the rates of stages `first` to `last` - 1 to the memory; stage, rate: Cells to use."""
    for s in range(first, last):
        for i in range(size):
            stage[i] = y[i]
        add_stages(size, data, A_AT + ALL_STAGES * s, s, h, memory, stage)
        rates(model, drive, t + data[C_AT + s] * h, stage, rate)
        keep_stage(size, s, rate, memory)


@formula
def keep_stage(size, s, rate, memory):
    """Write the rate of stage s to the memory."""
    for i in range(size):
        memory[stage_place(size) + size * s + i] = rate[i]


@formula
def dop853(model, drive, data, size, t, h, y, rate, memory, y_new, error):
    """Take one step and estimate its error; data: the packed table; else as for gragg."""
    bodies, rigid = counts(model)
    k = number_row(model.several, memory, 5, size)
    keep_stage(size, 0, rate, memory)
    take_stages(model, drive, data, size, t, h, y, 1, STAGES, memory, y_new, k)
    for i in range(size):
        y_new[i] = y[i]
        error[i] = 0.0
        k[i] = 0.0
    add_stages(size, data, A_AT + ALL_STAGES * STAGES, STAGES, h, memory, y_new)
    add_stages(size, data, E5_AT, STAGES, h, memory, error)
    add_stages(size, data, E3_AT, STAGES, h, memory, k)
    fifth, third = error_norm(bodies, rigid, y_new, error), error_norm(bodies, rigid, y_new, k)
    if fifth > 0.0:
        # The norm of the result is |e5|^2 / sqrt(|e5|^2 + 0.01 |e3|^2), as in the book; squares of
        # the ratio, which do not vanish with the errors.
        ratio = third / fifth
        factor = 1.0 / math.sqrt(1.0 + 0.01 * ratio * ratio)
        for i in range(size):
            error[i] = error[i] * factor


@formula
def times(size, slope, dense):
    """Multiply the polynomials by (1 + slope s) / 2."""
    for i in range(size):
        for d in range(_DEGREE, 0, -1):
            j = size * d + i
            dense[j] = 0.5 * dense[j] + 0.5 * slope * dense[j - size]
        dense[i] = 0.5 * dense[i]


@formula
def dense_dop853(model, drive, data, size, t, h, y, rate, y_new, rate_new, memory, dense):
    """Write the polynomials of a step; return the number of evaluations."""
    stage = number_row(model.several, memory, 5, size)
    k = number_row(model.several, memory, 6, size)
    keep_stage(size, 0, rate, memory)
    take_stages(model, drive, data, size, t, h, y, 1, STAGES, memory, stage, k)
    keep_stage(size, STAGES, rate_new, memory)
    take_stages(model, drive, data, size, t, h, y, STAGES + 1, ALL_STAGES, memory, stage, k)
    for j in range(DENSE_SIZE * size):
        dense[j] = 0.0
    for term in range(3, -1, -1):
        for i in range(size):
            k[i] = 0.0
        add_stages(size, data, D_AT + ALL_STAGES * term, ALL_STAGES, h, memory, k)
        for i in range(size):
            dense[i] = dense[i] + k[i]
        times(size, 1.0 if term % 2 == 1 else -1.0, dense)
    for i in range(size):
        dense[i] += 2.0 * (y_new[i] - y[i]) - h * (rate_new[i] + rate[i])
    times(size, 1.0, dense)
    for i in range(size):
        dense[i] += h * rate[i] - (y_new[i] - y[i])
    times(size, -1.0, dense)
    for i in range(size):
        dense[i] += y_new[i] - y[i]
    times(size, 1.0, dense)
    for i in range(size):
        dense[i] += y[i]
    return STAGES + 2
