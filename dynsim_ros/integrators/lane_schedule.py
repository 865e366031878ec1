# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
How the sub-sequences of an extrapolation share the four lanes, and how they are combined.

Extrapolation computes one step several times, with n = n_1, n_2, … substeps. The sequences do
not depend on each other: up to two of them run, one after the other, in each lane.
"""

from fractions import Fraction
from typing import NamedTuple

import numpy as np

from . import rational
from .stiffness import EXPLICIT_REACH
from ..physics.fused import fused
from ..physics.jit import formula
from ..physics.lanes import COUNT, lane, lanes_at, spread, total, totals

# Places of the parts of a table; each has four numbers, one for each lane. The last ones are those
# of a row, see place_of.
FIRST, SECOND, _ROWS = 0, COUNT, 2 * COUNT
WEIGHT, ERROR, ENDED, _ROW_SIZE = 0, COUNT, 2 * COUNT, 3 * COUNT


# Of the dense output: after steps of few digits and of Störmer's rule, and where it has to be more
# exact. These were found by comparing the errors of samples with those of the ends of steps.
QUICK, FINER = (2, 4, 6, 8, 10), (2, 4, 8, 10, 12)


class Sequences(NamedTuple):
    """
    The sequences that an extrapolation has where the tolerance is not below `least`.

    substeps, stages: see schedule; dense_substeps: see explicit_table; share, reach,
    keeps_reaches: see methods.Adaptive.
    """

    least: float
    substeps: tuple
    stages: int | None = None
    dense_substeps: tuple = QUICK
    share: float = 1.0
    reach: float = EXPLICIT_REACH
    keeps_reaches: bool = False


class Schedule(NamedTuple):
    """
    Sequences in lanes.

    stages: one more than powers of the error are taken away; rows: how many evaluations a lane
    takes, one after the other; ends: (rows,) whether a sequence ends in a row; table: substeps of
    the first and of the second sequence of each lane, then for each row the weights of the
    sequences that end there, in the result and in the error estimate, and 1 where such a sequence
    is the first one of its lane.
    """

    stages: int
    rows: int
    ends: np.ndarray
    table: np.ndarray


@formula
def place_of(row, part):
    """Return the place of a part of a row: WEIGHT, ERROR or ENDED."""
    return _ROWS + _ROW_SIZE * row + part


@formula
def begin_sums(size, sums, errors):
    """Let the sums of what sequences reach begin; Cells of Lanes."""
    for i in range(size):
        sums[i] = spread(0.0)
        errors[i] = spread(0.0)


@formula
def add_ended(table, row, size, reached, sums, errors):
    """
    Add to the sums what the sequences have reached that end in a row.

    reached: Cells of Lanes, less the state at the start of the step.
    """
    weight = lanes_at(table, place_of(row, WEIGHT))
    error_weight = lanes_at(table, place_of(row, ERROR))
    for i in range(size):
        sums[i] = fused(weight, reached[i], sums[i])
        errors[i] = fused(error_weight, reached[i], errors[i])


@formula
def combine(size, y, sums, errors, y_new, error):
    """Write the extrapolated state and the estimate of its error; y: Cells, state at the start."""
    fours = size - size % COUNT
    for i in range(0, fours, COUNT):
        changes = totals(sums[i], sums[i + 1], sums[i + 2], sums[i + 3])
        estimates = totals(errors[i], errors[i + 1], errors[i + 2], errors[i + 3])
        for k in range(COUNT):
            y_new[i + k] = y[i + k] + lane(changes, k)
            error[i + k] = lane(estimates, k)
    for i in range(fours, size):
        y_new[i] = y[i] + total(sums[i])
        error[i] = total(errors[i])


def extrapolation_weights(substeps, power, stages):
    """
    Return {n: weight} of the value at step length 0; the error has powers of h^power.

    They take the first stages - 1 of these powers away. Where there are more sequences than
    stages, they are those that let the least rounding through: a sequence of n substeps has some
    that is as 1 / sqrt(n).
    """
    def moment(j):
        return rational.total(Fraction(n, n ** (power * j)) for n in substeps)
    moments = [[moment(j + k) for k in range(stages)] for j in range(stages)]
    factors = [row[0] for row in rational.inverse(moments)]
    return {n: rational.total(factor * Fraction(n, n ** (power * j))
                              for j, factor in enumerate(factors)) for n in substeps}


def sequences_for(tolerance, several):
    """Return the first ones of several Sequences that are for a tolerance."""
    return next(each for each in several if tolerance >= each.least)


def schedule(substeps, power, evaluations, stages=None):
    """
    Return the Schedule of some sequences.

    substeps: ascending; power: 1 or 2, of the error expansion; evaluations(n): how many rows a
    sequence of n substeps takes; stages: as many as there are sequences, unless given. The error
    estimate is the difference to the result without the first sequence, of one stage less.
    """
    stages = len(substeps) if stages is None else stages
    lanes = [[] for _ in range(COUNT)]
    for each, n in zip(lanes, reversed(substeps)):
        each.append(n)
    # The others end as late as they can: all in the same row, where their lengths allow it.
    for n in reversed(substeps[:-COUNT]):
        free = [each for each in lanes if len(each) == 1]
        rows = max(_load(each, evaluations) for each in lanes)
        fitting = [each for each in free if _load(each, evaluations) + evaluations(n) <= rows]
        if fitting:
            max(fitting, key=lambda each: _load(each, evaluations)).append(n)
        else:
            min(free, key=lambda each: _load(each, evaluations)).append(n)
    rows = max(_load(each, evaluations) for each in lanes)
    weights = extrapolation_weights(substeps, power, stages)
    lower = {substeps[0]: Fraction(0)} | extrapolation_weights(substeps[1:], power, stages - 1)
    table, ends = np.zeros(_ROWS + _ROW_SIZE * rows), np.zeros(rows, dtype=np.bool_)
    # A lane without a sequence takes tiny substeps that nobody looks at.
    table[FIRST:FIRST + 2 * COUNT] = 1e3
    for i, each in enumerate(lanes):
        for number, n in enumerate(each):
            row = _load(each[:number + 1], evaluations) - 1
            ends[row] = True
            table[FIRST + COUNT * number + i] = n
            table[place_of(row, WEIGHT) + i] = weights[n]
            table[place_of(row, ERROR) + i] = weights[n] - lower[n]
            table[place_of(row, ENDED) + i] = number == 0
    return Schedule(stages, rows, ends, table)


def _load(substeps, evaluations):
    load = 0
    for n in substeps:
        load += evaluations(n)
    return load
