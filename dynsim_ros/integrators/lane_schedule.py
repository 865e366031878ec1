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
from ..physics.fused import fused
from ..physics.jit import formula
from ..physics.lanes import COUNT, lanes_at, total

# Places of the parts of a table; each is a row of four, one number for each lane.
FIRST, SECOND = 0, 4
FIRST_WEIGHT, SECOND_WEIGHT = 8, 12
FIRST_ERROR, SECOND_ERROR = 16, 20
ENDS = 24


class Schedule(NamedTuple):
    """
    Sequences in lanes.

    stages: one more than powers of the error are taken away; rows: how many evaluations a lane
    takes, one after the other; first_end: the first row in which a sequence ends; table: (ENDS +
    8 rows,): substeps of the first and of the second sequence of each lane, their weights in the
    result and in the error estimate, then for each row 1 where a first sequence ends, then the
    same for the second ones.
    """

    stages: int
    rows: int
    first_end: int
    table: np.ndarray


@formula
def combine(table, size, y, first, second, y_new, error):
    """
    Write the extrapolated state and the estimate of its error.

    table: of the Schedule; y: Cells, state at the start of the step; first, second: Cells of
    Lanes, what the sequences of each lane have reached, less y; 0 where there is no second one.
    """
    w_1, w_2 = lanes_at(table, FIRST_WEIGHT), lanes_at(table, SECOND_WEIGHT)
    e_1, e_2 = lanes_at(table, FIRST_ERROR), lanes_at(table, SECOND_ERROR)
    for i in range(size):
        y_new[i] = y[i] + total(fused(w_1, first[i], w_2 * second[i]))
        error[i] = total(fused(e_1, first[i], e_2 * second[i]))


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


def schedule(substeps, power, evaluations, stages=None):
    """
    Return the Schedule of some sequences.

    substeps: ascending; power: 1 or 2, of the error expansion; evaluations(n): how many rows a
    sequence of n substeps takes; stages: as many as there are sequences, unless given. The error
    estimate is the difference to the result without the first sequence, of one stage less.
    """
    stages = len(substeps) if stages is None else stages
    lanes = [[] for _ in range(COUNT)]
    for lane, n in zip(lanes, reversed(substeps)):
        lane.append(n)
    # The others end as late as they can: all in the same row, where their lengths allow it.
    for n in reversed(substeps[:-COUNT]):
        free = [lane for lane in lanes if len(lane) == 1]
        rows = max(_load(lane, evaluations) for lane in lanes)
        fitting = [lane for lane in free if _load(lane, evaluations) + evaluations(n) <= rows]
        if fitting:
            max(fitting, key=lambda lane: _load(lane, evaluations)).append(n)
        else:
            min(free, key=lambda lane: _load(lane, evaluations)).append(n)
    rows = max(_load(lane, evaluations) for lane in lanes)
    weights = extrapolation_weights(substeps, power, stages)
    lower = {substeps[0]: Fraction(0)} | extrapolation_weights(substeps[1:], power, stages - 1)
    table = np.zeros(ENDS + 2 * COUNT * rows)
    # A lane without a sequence takes tiny substeps that nobody looks at.
    table[FIRST:FIRST + 2 * COUNT] = 1e3
    for i, lane in enumerate(lanes):
        for place, n in enumerate(lane):
            table[FIRST + COUNT * place + i] = n
            table[FIRST_WEIGHT + COUNT * place + i] = weights[n]
            table[FIRST_ERROR + COUNT * place + i] = weights[n] - lower[n]
            end = _load(lane[:place + 1], evaluations) - 1
            table[ENDS + COUNT * (place * rows + end) + i] = 1.0
    return Schedule(stages, rows,
                    min(evaluations(lane[0]) for lane in lanes if lane) - 1, table)


def _load(lane, evaluations):
    load = 0
    for n in lane:
        load += evaluations(n)
    return load
