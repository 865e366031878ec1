# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Where a method keeps its intermediate states: in registers for a single body, else in memory.

The memory is one array: rows of Lanes first, then rows of numbers, each as long as a state,
then what a linearly implicit method keeps of every spring, and a matrix of springs by springs,
then what a collocation method keeps of its stages, and a matrix of springs times stages by the
same, with its pivots.
"""

import numpy as np

from ..physics.cells import lane_cells, number_cells
from ..physics.jit import formula, overload
from ..physics.lanes import COUNT

LANE_ROWS = 8
NUMBER_ROWS = 24

# Coefficients of a dense output for each number of the state: of the powers 0 to 13 of s, which is
# -1 at the start and 1 at the end of the step.
DENSE_SIZE = 14

# Numbers in a line of the processor's cache.
_LINE = 8

# What is kept of a spring [Lanes].
SPRING_SIZE = 20

# The stages of a collocation method, its rows of them, and what it keeps of a spring.
STAGES, STAGE_ROWS, STAGE_SPRING_SIZE = 8, 3, 17


def new_memory(size, springs):
    """Return memory for any method; size: length of the state; springs: how many there are."""
    # The kernels know of no difference between one spring and none: see Model.connections.
    springs = max(springs, 1)
    stages = STAGES * (STAGE_ROWS * size + 1 + springs * STAGE_SPRING_SIZE)
    return _zeros_in_line(stage_place(size, springs) + stages
                          + STAGES * springs * (STAGES * springs + 2))


def _zeros_in_line(count):
    """
    Return (count,) zeros that begin where a line of the processor's cache does.

    Lanes in them then never lie across two lines, which would cost a fifth of the time of a step.
    """
    whole = np.zeros(count + _LINE)
    first = -(whole.ctypes.data // whole.itemsize) % _LINE
    return whole[first:first + count]


def number_row(several, memory, row, size):
    """Return Cells for a state; row: below NUMBER_ROWS, each row is another place."""
    return number_cells(several, memory, (COUNT * LANE_ROWS + row) * size, size)


@overload(number_row, inline='always')
def _number_row(several, memory, row, size):
    return number_row


@formula
def spring_place(size):
    """Return where what is kept of the springs begins."""
    return (COUNT * LANE_ROWS + NUMBER_ROWS) * size


@formula
def stage_place(size, springs):
    """Return where what is kept of the stages begins."""
    return spring_place(size) + COUNT * springs * (SPRING_SIZE + 1 + springs)


def lane_row(several, memory, row, size):
    """Return Cells for the states in all lanes; row: below LANE_ROWS."""
    return lane_cells(several, memory, COUNT * row * size, size)


@overload(lane_row, inline='always')
def _lane_row(several, memory, row, size):
    return lane_row


@formula
def load(size, state, y):
    """Copy a state from an array to Cells."""
    for i in range(size):
        y[i] = state[i]


@formula
def store(size, y, state):
    """Copy a state from Cells to an array."""
    for i in range(size):
        state[i] = y[i]
