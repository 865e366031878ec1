# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The state within a step, as a polynomial; computed only for steps in which somebody wants it.

After an explicit step: Hermite's interpolation of states and rates at both ends and at four
instants between, which are computed by Gragg's method from the nearer end, one in each lane, and
of the changes of the rates at both ends, which cost one evaluation more.
After a linearly implicit one: Lagrange's interpolation of states at both ends and at eight
instants between, computed from the start, since what is stiff cannot be followed backwards. dop853
and radau have dense outputs of their own.

The coefficients are kept by powers of s: those of a power for all numbers of the state lie side by
side, so that four numbers are evaluated at once.
"""

from fractions import Fraction
from functools import lru_cache

import numpy as np

from .dop853 import dense_dop853
from .gragg import midpoint
from .lane_schedule import extrapolation_weights, FINER
from .linearly_implicit import linearly_implicit_substep
from .memory import DENSE_SIZE, lane_row, STAGES
from .radau import dense_radau
from .radau_tableau import nodes
from .rational import inverse
from ..physics.arms import arm_of_state, begin_arm, with_arm
from ..physics.fused import fused
from ..physics.jit import formula, part
from ..physics.lanes import choose, COUNT, lane, lanes_at, put_lanes, spread, total
from ..physics.motion import rates
from ..physics.reach import reach_of_state
from ..physics.state import omega_at, quaternion_at

# Coefficients of even powers of s come from sums of what is known at s and -s, those of odd powers
# from differences. Their weights, by ascending power, are dealt with in fours; the last are zero.
_FOURS = -(-DENSE_SIZE // (2 * COUNT))
_WEIGHTS = COUNT * _FOURS

# Instants within a step, on s: near the roots of the polynomials that are best for either.
# They lie on both sides of the middle; these are the ones behind it.
_EXPLICIT_NODES = [Fraction(s, 1000) for s in (240, 675)]
_STIFF_NODES = [Fraction(s, 100) for s in (16, 48, 74, 92)]
# How far before and behind the ends rates are compared, in steps: what the comparison leaves out
# goes as its square, what rounding makes of it as one over it.
_NEARBY = 2.0 ** -15
_STIFF_STAGES = 7


def _weights(values, derivatives, seconds, parity):
    """
    Return the rows, one for each datum, of its weights in the powers of one parity.

    values, derivatives, seconds: at which s > 0 there are values, first and second derivatives
    with respect to s; each datum is a sum or difference of two, at s and -s; parity: 0 or 1.
    """
    powers = range(parity, 2 * len(values + derivatives + seconds), 2)
    rows = [[s ** d for d in powers] for s in values]
    rows += [[d * s ** max(d - 1, 0) for d in powers] for s in derivatives]
    rows += [[d * (d - 1) * s ** max(d - 2, 0) for d in powers] for s in seconds]
    # A datum is twice the even or odd part.
    return [[weight / 2 for weight in column] for column in zip(*inverse(rows))]


# Places of the parts of the tables: the instants, the weights of the sequences, how many these are
# after an explicit step, how near rates are compared, how many substeps the sequences have, then
# the weights of the data: of all in even powers, then of all in odd ones.
_TARGETS, _SEQUENCES, _STAGES, _NEAR = 0, 2 * COUNT, 4 * COUNT - 1, 4 * COUNT
_SUBSTEPS, _DATA = 5 * COUNT, 7 * COUNT
# Data of an explicit step: values at the end and at the nodes, rates there, changes of the rates
# at the end; of a stiff one: values at the end and at the nodes.
_EXPLICIT_DATA, _STIFF_DATA = 7, 5


def _table(sequences, *known):
    """Return a table with the weights of sequences and data; known: see _weights."""
    weights = [row for parity in (0, 1) for row in _weights(*known, parity)]
    table = np.zeros(_DATA + _WEIGHTS * len(weights))
    table[_SEQUENCES:_SEQUENCES + len(sequences)] = sequences
    for number, row in enumerate(weights):
        place = _DATA + _WEIGHTS * number
        table[place:place + len(row)] = row
    return table


@lru_cache
def explicit_table(substeps=FINER):
    """
    Return the packed table of the interpolation after an explicit step.

    substeps: even, of the sequences that reach the instants between; 7 at most.
    """
    places, end = [Fraction(1), *_EXPLICIT_NODES], Fraction(1)
    weights = extrapolation_weights(substeps, 2, len(substeps))
    table = _table([weights[n] for n in substeps], places, places, [end])
    table[_STAGES] = len(substeps)
    table[_SUBSTEPS:_SUBSTEPS + len(substeps)] = substeps
    # In fractions of the step: on from the start, back from the end to behind the middle.
    ahead = [(1 - s) / 2 for s in _EXPLICIT_NODES]
    table[:COUNT] = [*ahead, *(-fraction for fraction in ahead)]
    table[COUNT:2 * COUNT] = [1.0, 1.0, 0.0, 0.0]
    # On both sides of the start, and of the end.
    table[_NEAR:_NEAR + COUNT] = [-_NEARBY, _NEARBY, -_NEARBY, _NEARBY]
    return table


@lru_cache
def stiff_table():
    """Return the packed table of the interpolation after a linearly implicit step."""
    substeps = list(range(1, _STIFF_STAGES + 1))
    weights = extrapolation_weights(substeps, 1, _STIFF_STAGES)
    table = _table([weights[n] for n in substeps], [Fraction(1), *_STIFF_NODES], [], [])
    table[:COUNT] = [(1 - s) / 2 for s in _STIFF_NODES]
    table[COUNT:2 * COUNT] = [(1 + s) / 2 for s in _STIFF_NODES]
    return table


@formula
def add_datum(table, number, count, four, even, odd, sums):
    """
    Add what a datum has in four even and four odd powers to their coefficients.

    number: of the datum, of `count`; four: which powers, from the lowest; even, odd: its sum and
    its difference over s and -s.
    """
    place = _DATA + _WEIGHTS * number + COUNT * four
    return (fused(lanes_at(table, place), even, sums[0]),
            fused(lanes_at(table, place + _WEIGHTS * count), odd, sums[1]))


@formula
def put_powers(size, dense, four, i, sums):
    """Write coefficients of number i of the state, see add_datum, to `dense`."""
    for k in range(COUNT):
        for parity in range(2):
            power = 2 * (COUNT * four + k) + parity
            if power < DENSE_SIZE:
                dense[size * power + i] = lane(sums[parity], k)


@lru_cache
def radau_table():
    """Return the rows of the interpolation of the stages of a collocation method."""
    stages = [2 * c - 1 for c in nodes()]
    nodes_used = [Fraction(-1), *stages]
    powers = inverse([[s ** d for d in range(len(nodes_used))] for s in nodes_used])
    rows = np.zeros(STAGES * DENSE_SIZE)
    for d, row in enumerate(powers):
        # The value at the start is taken as zero.
        rows[STAGES * d:STAGES * (d + 1)] = row[1:]
    return rows


@part
def fan_out(model, drive, table, size, t, step, y, rate, y_new, rate_new, memory, reached):
    """
    Write the states at the instants between, one in each lane, to `reached`.

    Without the reaches of several springs, which take long to be compiled: the errors of these
    states are not passed on.
    """
    a = lane_row(model.several, memory, 0, size)
    b = lane_row(model.several, memory, 1, size)
    f = lane_row(model.several, memory, 2, size)
    state = lane_row(model.several, memory, 4, size)
    base = lane_row(model.several, memory, 5, size)
    following = lane_row(model.several, memory, 6, size)
    way, from_start = step * lanes_at(table, _TARGETS), lanes_at(table, COUNT)
    start = choose(from_start, t, t + step)
    for i in range(size):
        base[i] = choose(from_start, y[i], y_new[i])
        reached[i] = base[i]
    whole, arm = with_arm(model), arm_of_state(model, base)
    reach = reach_of_state(model, drive, start, base, arm)
    for stage in range(int(table[_STAGES])):
        h, pairs = way / table[_SUBSTEPS + stage], int(table[_SUBSTEPS + stage]) // 2
        for i in range(size):
            a[i] = spread(0.0)
            b[i] = h * choose(from_start, rate[i], rate_new[i])
            state[i] = base[i] + b[i]
        begin_arm(arm, h, base, a, b)
        passed = h
        for pair in range(pairs):
            midpoint(whole, drive, start, passed, h, base, arm, reach, None, a, b, state, f,
                     following)
            passed = passed + h
            if pair == pairs - 1:
                break
            midpoint(whole, drive, start, passed, h, base, arm, reach, None, b, a, following, f,
                     state)
            passed = passed + h
        weight = table[_SEQUENCES + stage]
        for i in range(size):
            reached[i] = reached[i] + weight * a[i]


@part
def dense_explicit(model, drive, table, size, t, step, y, rate, y_new, rate_new, memory, dense):
    """Write the polynomials of a step; return the number of evaluations in a row."""
    reached = lane_row(model.several, memory, 3, size)
    f = lane_row(model.several, memory, 2, size)
    nearby = lane_row(model.several, memory, 5, size)
    changing = lane_row(model.several, memory, 4, size)
    fan_out(model, drive, table, size, t, step, y, rate, y_new, rate_new, memory, reached)
    from_start, near = lanes_at(table, COUNT), step * lanes_at(table, _NEAR)
    begin = choose(from_start, t, t + step)
    rates(model, drive, begin + step * lanes_at(table, _TARGETS), reached, f)
    for i in range(size):
        nearby[i] = fused(near, choose(from_start, rate[i], rate_new[i]),
                          choose(from_start, y[i], y_new[i]))
    rates(model, drive, begin + near, nearby, changing)
    half = 0.5 * step
    # From a difference over twice the distance to the second derivative with respect to s.
    per_difference = 0.125 * step / _NEARBY
    for i in range(size):
        values, slopes = reached[i] - y[i], half * f[i]
        change = y_new[i] - y[i]
        at_start = per_difference * (lane(changing[i], 1) - lane(changing[i], 0))
        at_end = per_difference * (lane(changing[i], 3) - lane(changing[i], 2))
        for four in range(_FOURS):
            sums = (spread(0.0), spread(0.0))
            sums = add_datum(table, 0, _EXPLICIT_DATA, four, change, change, sums)
            # A derivative of an even function is odd.
            sums = add_datum(table, 3, _EXPLICIT_DATA, four, half * (rate_new[i] - rate[i]),
                             half * (rate_new[i] + rate[i]), sums)
            sums = add_datum(table, 6, _EXPLICIT_DATA, four, at_end + at_start, at_end - at_start,
                             sums)
            for k in range(2):
                before, behind = lane(values, k), lane(values, k + 2)
                sums = add_datum(table, 1 + k, _EXPLICIT_DATA, four, behind + before,
                                 behind - before, sums)
                before, behind = lane(slopes, k), lane(slopes, k + 2)
                sums = add_datum(table, 4 + k, _EXPLICIT_DATA, four, behind - before,
                                 behind + before, sums)
            put_powers(size, dense, four, i, sums)
        dense[i] += y[i]
    evaluations = 2
    for stage in range(int(table[_STAGES])):
        evaluations += int(table[_SUBSTEPS + stage]) - 1
    return evaluations


@formula
def stiff_fan_out(model, drive, table, targets, size, t, step, y, memory, here, f, responses,
                  reached):
    """
    Write how far the state has come at four instants between, one in each lane, to `reached`.

    targets: where in the table the instants are; here, f, responses: Cells to use.
    """
    way = step * lanes_at(table, targets)
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


@formula
def dense_stiff(model, drive, table, size, t, step, y, y_new, memory, dense):
    """Write the polynomials of a linearly implicit step; return the number of evaluations."""
    here = lane_row(model.several, memory, 0, size)
    f = lane_row(model.several, memory, 2, size)
    responses = lane_row(model.several, memory, 3, size)
    early = lane_row(model.several, memory, 1, size)
    late = lane_row(model.several, memory, 4, size)
    stiff_fan_out(model, drive, table, _TARGETS, size, t, step, y, memory, here, f, responses,
                  early)
    stiff_fan_out(model, drive, table, _TARGETS + COUNT, size, t, step, y, memory, here, f,
                  responses, late)
    for i in range(size):
        change = y_new[i] - y[i]
        for four in range(_FOURS):
            sums = (spread(0.0), spread(0.0))
            sums = add_datum(table, 0, _STIFF_DATA, four, change, change, sums)
            for k in range(COUNT):
                before, behind = lane(early[i], k), lane(late[i], k)
                sums = add_datum(table, 1 + k, _STIFF_DATA, four, behind + before,
                                 behind - before, sums)
            put_powers(size, dense, four, i, sums)
        dense[i] += y[i]
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
def evaluate_dense(size, dense, s, i):
    """Return numbers i to i + 3 of the state at s, from -1 at the start of the step to 1."""
    square = s * s
    even = lanes_at(dense, size * (DENSE_SIZE - 2) + i)
    odd = lanes_at(dense, size * (DENSE_SIZE - 1) + i)
    for power in range(DENSE_SIZE - 4, -2, -2):
        even = fused(even, square, lanes_at(dense, size * power + i))
        odd = fused(odd, square, lanes_at(dense, size * (power + 1) + i))
    return fused(odd, s, even)


@formula
def write_state(size, dense, s, state):
    """Write the state at s to state: (size,); its quaternions are left as they come out."""
    for i in range(0, size, COUNT):
        # The last four may overlap those before them.
        first = min(i, size - COUNT)
        put_lanes(state, first, evaluate_dense(size, dense, s, first))


@formula
def write_two_states(size, dense, s, state, s_next, state_next):
    """Write the states at two instants: faster than one after the other."""
    for i in range(0, size, COUNT):
        first = min(i, size - COUNT)
        # Both before the first is written: coefficients in registers serve both.
        numbers = evaluate_dense(size, dense, s, first)
        numbers_next = evaluate_dense(size, dense, s_next, first)
        put_lanes(state, first, numbers)
        put_lanes(state_next, first, numbers_next)


@formula
def make_unit(bodies, rigid, state):
    """Normalise the quaternions of a state: their norms are near 1."""
    for i in range(quaternion_at(bodies), omega_at(bodies, rigid), COUNT):
        q = lanes_at(state, i)
        # One step of Newton's method is exact.
        put_lanes(state, i, (1.5 - 0.5 * total(q * q)) * q)
