# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The state within a step, as a polynomial; computed only for steps in which somebody wants it.

After an explicit step: Hermite's interpolation of states and rates at both ends and at four
instants between, which are computed by Gragg's method from the nearer end, one in each lane.
After a linearly implicit one: Lagrange's interpolation of states at both ends and at eight
instants between, computed from the start, since what is stiff cannot be followed backwards. dop853
and radau have dense outputs of their own.
"""

from fractions import Fraction
from functools import lru_cache

import numpy as np

from .dop853 import dense_dop853
from .gragg import midpoint
from .lane_schedule import extrapolation_weights
from .linearly_implicit import linearly_implicit_substep
from .memory import DENSE_SIZE, lane_row, STAGES
from .radau import dense_radau
from .radau_tableau import nodes
from .rational import inverse
from ..physics.arms import arm_of_state, begin_arm, swap_arms, with_arm
from ..physics.fused import fused
from ..physics.jit import formula, part
from ..physics.lanes import choose, COUNT, lane, lanes_at, put_lanes, spread
from ..physics.motion import rates
from ..physics.reach import reach_of_state
from ..physics.state import omega_at, put_quaternion, quaternion, quaternion_at

_FOURS = DENSE_SIZE // COUNT

# Instants within a step, on s: near the roots of the polynomials that are best for either.
_EXPLICIT_NODES = [Fraction(s, 100) for s in (-77, -29, 29, 77)]
_STIFF_NODES = [Fraction(s, 100) for s in (-92, -74, -48, -16, 16, 48, 74, 92)]
_EXPLICIT_STAGES = 6
_STIFF_STAGES = 7


def _powers(nodes, derivatives):
    """
    Return the rows, one for each power of s, of the weights of values, then of derivatives.

    nodes: where values are given, s = -1 first (its value is taken as zero); derivatives: where
    derivatives with respect to s are given.
    """
    nodes_used = nodes[1:]
    count = len(nodes) + len(derivatives)
    rows = [[s ** d for d in range(count)] for s in nodes]
    rows += [[d * s ** (d - 1) if d else Fraction(0) for d in range(count)] for s in derivatives]
    return [[row[nodes.index(s)] for s in nodes_used] + row[len(nodes):]
            for row in inverse(rows)]


# Places of the parts of the tables: the instants, the weights of the sequences, then a column for
# each of these, with its weights in all powers: the lanes' values, the lanes' rates (or second
# values), the value at the end, and the rates at the start and at the end.
_TARGETS, _SEQUENCES, _COLUMNS = 0, 2 * COUNT, 4 * COUNT
_AT_END, _RATE_AT_START, _RATE_AT_END = 2 * COUNT, 2 * COUNT + 1, 2 * COUNT + 2


@lru_cache
def explicit_table():
    """Return the packed table of the interpolation after an explicit step."""
    ends = [Fraction(-1), Fraction(1)]
    nodes = [ends[0], *_EXPLICIT_NODES, ends[1]]
    table = np.zeros(_COLUMNS + DENSE_SIZE * (_RATE_AT_END + 1))
    # In fractions of the step, from the start or back from the end.
    table[:COUNT] = [(s + 1) / 2 if s < 0 else (s - 1) / 2 for s in _EXPLICIT_NODES]
    table[COUNT:2 * COUNT] = [float(s < 0) for s in _EXPLICIT_NODES]
    substeps = list(range(2, 2 * _EXPLICIT_STAGES + 1, 2))
    weights = extrapolation_weights(substeps, 2, _EXPLICIT_STAGES)
    table[_SEQUENCES:_SEQUENCES + len(substeps)] = [weights[n] for n in substeps]
    for d, row in enumerate(_powers(nodes, nodes)):
        values, rates_ = row[:5], row[5:]
        table[_COLUMNS + d::DENSE_SIZE] = [*values[:4], *rates_[1:5], values[4], rates_[0],
                                           rates_[5]]
    return table


@lru_cache
def stiff_table():
    """Return the packed table of the interpolation after a linearly implicit step."""
    nodes = [Fraction(-1), *_STIFF_NODES, Fraction(1)]
    table = np.zeros(_COLUMNS + DENSE_SIZE * (_AT_END + 1))
    table[:2 * COUNT] = [(s + 1) / 2 for s in _STIFF_NODES]
    substeps = list(range(1, _STIFF_STAGES + 1))
    weights = extrapolation_weights(substeps, 1, _STIFF_STAGES)
    table[_SEQUENCES:_SEQUENCES + len(substeps)] = [weights[n] for n in substeps]
    for d, row in enumerate(_powers(nodes, [])):
        table[_COLUMNS + d::DENSE_SIZE] = row
    return table


@formula
def column(table, number, powers):
    """Return the weights of a column in four powers of s; powers: which four of them."""
    return lanes_at(table, _COLUMNS + DENSE_SIZE * number + COUNT * powers)


@lru_cache
def radau_table():
    """Return the rows of the interpolation of the stages of a collocation method."""
    stages = [2 * c - 1 for c in nodes()]
    rows = np.zeros(STAGES * DENSE_SIZE)
    for d, row in enumerate(_powers([Fraction(-1), *stages], [])):
        rows[STAGES * d:STAGES * (d + 1)] = row
    return rows


@part
def fan_out(model, drive, table, size, t, step, y, rate, y_new, rate_new, memory, reached):
    """Write the states at the instants between, one in each lane, to `reached`."""
    a = lane_row(model.several, memory, 0, size)
    b = lane_row(model.several, memory, 1, size)
    f = lane_row(model.several, memory, 2, size)
    state = lane_row(model.several, memory, 4, size)
    base = lane_row(model.several, memory, 5, size)
    way, from_start = step * lanes_at(table, _TARGETS), lanes_at(table, COUNT)
    start = choose(from_start, t, t + step)
    for i in range(size):
        base[i] = choose(from_start, y[i], y_new[i])
        reached[i] = base[i]
    whole, arm = with_arm(model), arm_of_state(model, base)
    reach = reach_of_state(model, drive, start, base, arm)
    for stage in range(_EXPLICIT_STAGES):
        h = way / (2.0 * (stage + 1))
        for i in range(size):
            a[i] = spread(0.0)
            b[i] = h * choose(from_start, rate[i], rate_new[i])
        begin_arm(arm, h, base, a, b)
        passed = h
        for _ in range(2 * stage + 1):
            midpoint(whole, drive, size, start, passed, h, base, arm, reach, a, b, state, f)
            passed = passed + h
            for i in range(size):
                # The one that is ahead comes to lie in b.
                f[i] = a[i]
                a[i] = b[i]
                b[i] = f[i]
            swap_arms(arm, a, b)
        weight = table[_SEQUENCES + stage]
        for i in range(size):
            reached[i] = reached[i] + weight * b[i]


@part
def dense_explicit(model, drive, table, size, t, step, y, rate, y_new, rate_new, memory, dense):
    """Write the polynomials of a step; return the number of evaluations in a row."""
    reached = lane_row(model.several, memory, 3, size)
    f = lane_row(model.several, memory, 2, size)
    fan_out(model, drive, table, size, t, step, y, rate, y_new, rate_new, memory, reached)
    now = choose(lanes_at(table, COUNT), t, t + step) + step * lanes_at(table, _TARGETS)
    rates(model, drive, now, reached, f)
    half = 0.5 * step
    for i in range(size):
        values, slopes = reached[i] - y[i], half * f[i]
        for powers in range(_FOURS):
            sums = column(table, _AT_END, powers) * (y_new[i] - y[i])
            sums = fused(column(table, _RATE_AT_START, powers), half * rate[i], sums)
            sums = fused(column(table, _RATE_AT_END, powers), half * rate_new[i], sums)
            for k in range(COUNT):
                sums = fused(column(table, k, powers), lane(values, k), sums)
                sums = fused(column(table, COUNT + k, powers), lane(slopes, k), sums)
            put_lanes(dense, DENSE_SIZE * i + COUNT * powers, sums)
        dense[DENSE_SIZE * i] += y[i]
    return _EXPLICIT_STAGES * _EXPLICIT_STAGES + 1


@formula
def dense_stiff(model, drive, table, size, t, step, y, y_new, memory, dense):
    """Write the polynomials of a linearly implicit step; return the number of evaluations."""
    here = lane_row(model.several, memory, 0, size)
    reached = lane_row(model.several, memory, 1, size)
    f = lane_row(model.several, memory, 2, size)
    responses = lane_row(model.several, memory, 3, size)
    for i in range(size):
        for powers in range(_FOURS):
            put_lanes(dense, DENSE_SIZE * i + COUNT * powers,
                      column(table, _AT_END, powers) * (y_new[i] - y[i]))
    for batch in range(2):
        way = step * lanes_at(table, _TARGETS + COUNT * batch)
        for i in range(size):
            reached[i] = spread(0.0)
        for stage in range(_STIFF_STAGES):
            h = way / (stage + 1.0)
            now = spread(t)
            for i in range(size):
                here[i] = spread(y[i])
            for _ in range(stage + 1):
                linearly_implicit_substep(model, drive, now, h, memory, here, f, responses)
                now = now + h
            weight = table[_SEQUENCES + stage]
            for i in range(size):
                reached[i] = reached[i] + weight * (here[i] - y[i])
        for i in range(size):
            for powers in range(_FOURS):
                place = DENSE_SIZE * i + COUNT * powers
                sums = lanes_at(dense, place)
                for k in range(COUNT):
                    weights = column(table, COUNT * batch + k, powers)
                    sums = fused(weights, lane(reached[i], k), sums)
                put_lanes(dense, place, sums)
    for i in range(size):
        dense[DENSE_SIZE * i] += y[i]
    return _STIFF_STAGES * (_STIFF_STAGES + 1)


@formula
def build_dense(stiff_plan, dop853_data, radau_data, model, drive, table, size, t, step, y, rate,
                y_new, rate_new, memory, dense):
    """Write the polynomials of the last step to `dense`; return the number of evaluations."""
    if stiff_plan is not None:
        return dense_stiff(model, drive, table, size, t, step, y, y_new, memory, dense)
    if dop853_data is not None:
        return dense_dop853(model, drive, dop853_data, size, t, step, y, rate, y_new, rate_new,
                            memory, dense)
    if radau_data is not None:
        return dense_radau(model, table, size, y, memory, dense)
    return dense_explicit(model, drive, table, size, t, step, y, rate, y_new, rate_new, memory,
                          dense)


@formula
def evaluate_dense(bodies, rigid, size, dense, s, y):
    """Write the state at s, from -1 at the start of the step to 1 at its end, to Cells y."""
    for i in range(size):
        x = dense[DENSE_SIZE * i + DENSE_SIZE - 1] + 0.0 * s
        for d in range(DENSE_SIZE - 2, -1, -1):
            x = fused(x, s, dense[DENSE_SIZE * i + d])
        y[i] = x
    for i in range(quaternion_at(bodies), omega_at(bodies, rigid), 4):
        # The norm is near 1: one step of Newton's method is exact.
        q = quaternion(y, i)
        factor = 1.5 - 0.5 * (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
        put_quaternion(y, i, (factor * q[0], factor * q[1], factor * q[2], factor * q[3]))


@formula
def write_states(bodies, rigid, size, dense, place, count, memory, y, lanes, states):
    """
    Write the states at `count` instants to states[place:]; count: 1 or COUNT.

    memory[:count]: the instants, on s; y, lanes: Cells of numbers and of Lanes to use.
    """
    if count == 1:
        evaluate_dense(bodies, rigid, size, dense, memory[0], y)
        for i in range(size):
            states[place, i] = y[i]
    else:
        evaluate_dense(bodies, rigid, size, dense, lanes_at(memory, 0), lanes)
        for i in range(size):
            for k in range(COUNT):
                states[place + k, i] = lane(lanes[i], k)
